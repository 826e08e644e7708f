// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** Where the miniature is cut: a plane in the map's coordinates that snaps to storeys or is held freely. */

import { Plane, Vector3 } from "three";
import type { Storey } from "../client/state";

/** A storey is cut at this height over its floor [m]: below lintels, above tables, as plans are drawn. */
export const CUT_OVER_FLOOR_M = 1.4;
/** How near the hand must be to a storey's cut for it to snap, as a part of the building's height. */
const SNAP_PART = 0.035;
const SNAP_LEAST_M = 0.25;
/** What people walk on is shown while so much of what is over it is kept [m]: keypoints and the path by one rule. */
const KEPT_OVER_FLOOR_M = 0.1;

export class Clip {
  /** What lies on the normal's negative side is cut away; in the map's coordinates. */
  readonly plane = new Plane(new Vector3(0, 0, -1), 0);
  /** Rises with each change. */
  version = 0;
  active = false;
  /** The storey whose cut the plane has snapped to, −1: none. */
  storey = -1;
  private low = 0;
  private high = 1;
  private floors: readonly number[] = [];

  reset(low: number, high: number, storeys: readonly Storey[]): void {
    this.low = low;
    this.high = high;
    this.floors = storeys.map((storey) => storey.floorZ);
    this.open();
  }

  /** Cuts nothing. */
  open(): void {
    this.active = false;
    this.storey = -1;
    this.level(this.high + 0.05);
  }

  cutStorey(storey: number): void {
    if (storey < 0 || storey >= this.floors.length) {
      this.open();
      return;
    }
    this.level(this.cutOf(storey));
    this.active = true;
    this.storey = storey;
  }

  /** Cuts level at the height [m], or at a storey that is near. At the top nothing is cut. */
  cutAt(z: number, snap: boolean): void {
    const height = Math.min(this.high + 0.05, Math.max(this.low + 0.05, z));
    const storey = snap ? this.near(height) : -1;
    if (storey >= 0) {
      if (storey !== this.storey || !this.active) this.cutStorey(storey);
      return;
    }
    this.storey = -1;
    this.active = height < this.high;
    this.level(height);
  }

  /** Cuts along any plane through the point; what lies where the normal points is taken away. */
  cutAlong(normal: Vector3, point: Vector3): void {
    this.plane.normal.copy(normal).negate();
    this.plane.constant = normal.dot(point);
    this.active = true;
    this.storey = -1;
    this.version += 1;
  }

  /** Height of the plane where it stands level; of its middle where it is held askew [m]. */
  heightAt(x: number, y: number): number {
    const { normal, constant } = this.plane;
    if (Math.abs(normal.z) < 1e-3) return this.high;
    return -(constant + normal.x * x + normal.y * y) / normal.z;
  }

  isLevel(): boolean {
    return this.plane.normal.z < -0.9999;
  }

  /** True for what is not cut away. */
  keeps(x: number, y: number, z: number): boolean {
    const { normal, constant } = this.plane;
    return !this.active || normal.x * x + normal.y * y + normal.z * z + constant >= 0;
  }

  /** True for what stands on a floor that is not cut away, however high it is drawn over it. */
  keepsOnFloor(x: number, y: number, floorZ: number): boolean {
    return this.keeps(x, y, floorZ + KEPT_OVER_FLOOR_M);
  }

  /** Writes the plane that cuts, by the rule of `keepsOnFloor`, what is drawn so high over its floor [m]. */
  writeRaised(overFloorM: number, out: Plane): void {
    out.copy(this.plane);
    out.constant -= this.plane.normal.z * Math.max(0, overFloorM - KEPT_OVER_FLOOR_M);
  }

  /** The storey that one looks down on: the highest whose floor is below the cut. */
  get openStorey(): number {
    if (!this.active) return -1;
    if (this.storey >= 0) return this.storey;
    const height = this.isLevel() ? this.plane.constant : this.high;
    let found = -1;
    for (let i = 0; i < this.floors.length; i++) if (this.floors[i] < height) found = i;
    return found;
  }

  private cutOf(storey: number): number {
    const next = this.floors[storey + 1] ?? this.high;
    return Math.min(this.floors[storey] + CUT_OVER_FLOOR_M, Math.max(this.floors[storey] + 0.3, next - 0.1));
  }

  private near(height: number): number {
    const reach = Math.max(SNAP_LEAST_M, SNAP_PART * (this.high - this.low));
    let best = -1;
    let least = reach;
    for (let i = 0; i < this.floors.length; i++) {
      const distance = Math.abs(this.cutOf(i) - height);
      if (distance < least) [best, least] = [i, distance];
    }
    return best;
  }

  private level(height: number): void {
    this.plane.normal.set(0, 0, -1);
    this.plane.constant = height;
    this.version += 1;
  }
}
