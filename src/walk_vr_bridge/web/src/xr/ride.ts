// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/**
 * The ride in first person, without a renderer: where the rig's user shall be and how it shall be turned. The tour turns the
 * rig about the upright only; who strays is led back along the way that was strayed.
 */

import { Trail } from "./trail";

/** `off`: not riding. `on`: the tour carries the user. `strayed`: the user walks alone. `back`: led back to the tour. */
export type RidePhase = "off" | "on" | "strayed" | "back";

export interface Stand {
  /** Of the map [m]; z is the floor's. */
  x: number;
  y: number;
  z: number;
  /** About the map's z [rad]. */
  heading: number;
}

/** One is led back at a calm walk [m/s]; a crumb farther than this from the next was a jump, and so is the way back [m]. */
export const BACK_MPS = 1.4;
const JUMP_M = 2;
/** From one frame to the next the tour moves less than this, unless somebody seeks [m]. */
export const LEAP_M = 0.8;

export class Ride {
  phase: RidePhase = "off";
  /** When the tour was left [s]. */
  leftAtS = 0;
  /** Speed [m/s] and turn [rad/s] of the last step: what the vignette goes by. */
  speed = 0;
  turnRate = 0;
  /** The last step was a jump: to be hidden by a fade. */
  leapt = false;
  readonly trail = new Trail();

  begin(): void {
    this.phase = "on";
    this.leapt = true;
    this.speed = this.turnRate = 0;
  }

  end(): void {
    this.phase = "off";
    this.speed = this.turnRate = 0;
    this.trail.clear();
  }

  /** The user goes another way: the place is remembered. */
  stray(timeS: number, stand: Stand): void {
    if (this.phase === "off") return;
    if (this.phase === "on") {
      this.leftAtS = timeS;
      this.trail.clear();
      this.trail.drop(stand.x, stand.y, stand.z);
    }
    this.phase = "strayed";
    this.speed = this.turnRate = 0;
  }

  /** The user has walked alone to a place. */
  wander(x: number, y: number, z: number): void {
    if (this.phase === "strayed") this.trail.drop(x, y, z);
  }

  leadBack(): void {
    if (this.phase === "strayed") this.phase = "back";
  }

  /** Moves `now` with the tour, which stands at `goal`. */
  follow(now: Stand, goal: Stand, seconds: number): void {
    const way = Math.hypot(goal.x - now.x, goal.y - now.y, goal.z - now.z);
    const turn = wrapAngle(goal.heading - now.heading);
    this.leapt = way > LEAP_M;
    this.speed = this.leapt || seconds <= 0 ? 0 : way / seconds;
    this.turnRate = this.leapt || seconds <= 0 ? 0 : turn / seconds;
    now.x = goal.x;
    now.y = goal.y;
    now.z = goal.z;
    now.heading += turn;
  }

  /** Moves `now` back along the trail; true once the tour is reached and goes on. */
  walkBack(now: Stand, seconds: number): boolean {
    this.leapt = false;
    this.turnRate = 0;
    let left = BACK_MPS * seconds;
    while (left > 0 && this.trail.count > 0) {
      const last = this.trail.count - 1;
      const [dx, dy, dz] = [this.trail.x(last) - now.x, this.trail.y(last) - now.y, this.trail.z(last) - now.z];
      const way = Math.hypot(dx, dy, dz);
      const jump = way > JUMP_M;
      const part = jump || way <= left ? 1 : left / way;
      now.x += dx * part;
      now.y += dy * part;
      now.z += dz * part;
      left -= jump ? left : Math.max(1e-4, way * part);
      this.leapt ||= jump;
      if (part === 1) this.trail.count = last;
    }
    this.speed = this.leapt ? 0 : BACK_MPS;
    if (this.trail.count > 0) return false;
    this.phase = "on";
    return true;
  }
}

/** The same turn within half a circle either way [rad]. */
export function wrapAngle(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}
