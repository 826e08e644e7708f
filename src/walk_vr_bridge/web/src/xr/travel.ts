// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Vector3 } from "three";
import type { SettingsState } from "../client/state";
import type { Stage } from "../scene/stage";
import { type Comfort, vignetteFor } from "./comfort";
import type { HandInput, Inputs } from "./input";
import type { Rig } from "./rig";
import { Teleport } from "./teleport";

/** A brisk walk [m/s]; a smooth turn [rad/s]; a snap [rad]. */
export const WALK_MPS = 1.7;
const TURN_RADPS = 1.2;
export const SNAP_RAD = Math.PI / 6;
const DEAD = 0.15;
/** Feet follow floors this far up and down in one frame [m]. */
const STEP_M = 0.45;
/** One stops this far before a wall [m], felt for at this height over the floor. */
const BODY_M = 0.28;
const CHEST_M = 1.1;

/** Walking, turning and teleporting of one's own accord. */
export class Travel {
  readonly teleport: Teleport;
  /** Speed [m/s] that the stick asked for in this frame. */
  speed = 0;
  /** True in the frame in which the user jumped. */
  jumped = false;
  private aiming: HandInput | null = null;

  constructor(
    private readonly stage: Stage,
    private readonly rig: Rig,
    private readonly comfort: Comfort,
  ) {
    this.teleport = new Teleport(stage);
  }

  update(inputs: Inputs, settings: SettingsState, seconds: number): void {
    const strong = inputs.of(settings.hand);
    const weak = inputs.other(strong);
    this.jumped = false;
    this.speed = 0;
    if (!strong.atPanel) this.turn(strong, settings, seconds);
    const walking = settings.teleport ? weak : strong.stickY !== 0 ? strong : weak;
    if (!walking.atPanel) this.walk(walking, seconds);
    if (settings.teleport && strong.forward.pressed && !strong.atPanel) this.aiming = strong;
    this.aim(settings);
  }

  /** A bare hand that pinches at nothing aims, too. */
  beginAim(hand: HandInput): void {
    this.aiming = hand;
  }

  private aim(settings: SettingsState): void {
    const hand = this.aiming;
    if (!hand) return;
    const held = hand.bare ? hand.trigger.down : hand.forward.down;
    if (held) {
      this.teleport.aim(hand);
      return;
    }
    this.aiming = null;
    if (this.teleport.valid) {
      const { target } = this.teleport;
      this.goTo(target.x, target.y, target.z, settings.fade);
      hand.pulse(0.4, 30);
    }
    this.teleport.stop();
  }

  /** Puts the user on a floor of the map. */
  goTo(x: number, y: number, z: number, fade: boolean): void {
    if (fade) this.comfort.blink();
    this.rig.headTo(x, z, -y);
    this.jumped = true;
  }

  private turn(hand: HandInput, settings: SettingsState, seconds: number): void {
    if (settings.snapTurn) {
      const side = (hand.left.pressed ? 1 : 0) - (hand.right.pressed ? 1 : 0);
      if (side === 0) return;
      if (settings.fade) this.comfort.fade = Math.max(this.comfort.fade, 0.5);
      this.rig.turn(side * SNAP_RAD);
    } else if (Math.abs(hand.stickX) > DEAD) {
      this.rig.turn(-hand.stickX * TURN_RADPS * seconds);
      this.comfort.narrow(vignetteFor(0, hand.stickX * TURN_RADPS));
    }
  }

  private walk(hand: HandInput, seconds: number): void {
    const strength = Math.hypot(hand.stickX, hand.stickY);
    this.speed = strength > DEAD ? Math.min(1, strength) * WALK_MPS : 0;
    if (this.speed === 0) return;
    this.stage.view.camera.getWorldDirection(AHEAD);
    AHEAD.y = 0;
    AHEAD.normalize();
    STEP.set(-AHEAD.z, 0, AHEAD.x).multiplyScalar(hand.stickX).addScaledVector(AHEAD, -hand.stickY);
    STEP.normalize().multiplyScalar(this.speed * seconds);
    if (!this.blocked(STEP)) this.rig.move(STEP.x, this.climb(STEP), STEP.z);
  }

  /** Whether a wall stands in the way of a step in the room. */
  private blocked(step: Vector3): boolean {
    const bvh = this.stage.models?.bvh;
    const { eye } = this.stage.view;
    const length = step.length();
    if (!bvh || length === 0) return false;
    const z = this.rig.group.position.y + CHEST_M;
    return bvh.cast(eye.x, -eye.z, z, step.x / length, -step.z / length, 0, 0, length + BODY_M).distance < Infinity;
  }

  /** How far the floor rises under the place the step leads to [m]. */
  private climb(step: Vector3): number {
    const bvh = this.stage.models?.bvh;
    const { eye } = this.stage.view;
    if (!bvh) return 0;
    const chest = this.rig.group.position.y + CHEST_M;
    const hit = bvh.cast(eye.x + step.x, -eye.z - step.z, chest, 0, 0, -1, 0, CHEST_M + STEP_M);
    if (hit.distance === Infinity) return 0;
    const rise = CHEST_M - hit.distance;
    return Math.abs(rise) <= STEP_M ? rise : 0;
  }
}

const AHEAD = new Vector3();
const STEP = new Vector3();
