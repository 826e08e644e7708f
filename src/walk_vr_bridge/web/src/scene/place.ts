// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import type { Group, Matrix4, Quaternion, Vector3 } from "three";
import { Matrix4 as Matrix, Vector3 as Vector } from "three";
import type { Keypoint } from "../client/state";

/** A ray in some coordinates; the direction is of unit length. */
export interface Ray {
  readonly origin: Vector3;
  readonly direction: Vector3;
}

export function makeRay(): Ray {
  return { origin: new Vector(), direction: new Vector() };
}

/**
 * A place where the building is shown: full scale, or the miniature. Keypoints and path are drawn `belowEyeM` under the eye, so
 * that neither the cut of a storey nor the walker's own head is in the way.
 */
export class Place {
  readonly ray = makeRay();
  private readonly inverse = new Matrix();

  constructor(
    readonly name: "full" | "miniature",
    readonly group: Group,
    readonly belowEyeM: number,
  ) {}

  get scale(): number {
    return Math.abs(this.group.matrixWorld.getMaxScaleOnAxis());
  }

  get matrix(): Matrix4 {
    return this.group.matrixWorld;
  }

  /** From the room into the map's coordinates. */
  toMap(room: Vector3, out: Vector3): Vector3 {
    return out.copy(room).applyMatrix4(this.inverse.copy(this.group.matrixWorld).invert());
  }

  toRoom(map: Vector3, out: Vector3): Vector3 {
    return out.copy(map).applyMatrix4(this.group.matrixWorld);
  }

  /** Where a keypoint at the eye is drawn, in the room. */
  shown(position: readonly [number, number, number], out: Vector3): Vector3 {
    return this.toRoom(out.set(position[0], position[1], position[2] - this.belowEyeM), out);
  }

  /** Heading in the map [rad] of something that looks along −z in the room's turn, as controllers do. */
  heading(turn: Quaternion): number {
    AHEAD.set(0, 0, -1).applyQuaternion(turn);
    AHEAD.transformDirection(this.inverse.copy(this.group.matrixWorld).invert());
    return Math.atan2(AHEAD.y, AHEAD.x);
  }

  /** Brings a ray of the room into the map; it stands in `ray`. */
  rayToMap(room: Ray): Ray {
    this.inverse.copy(this.group.matrixWorld).invert();
    this.ray.origin.copy(room.origin).applyMatrix4(this.inverse);
    this.ray.direction.copy(room.direction).transformDirection(this.inverse);
    return this.ray;
  }

  /** The nearest keypoint to a point of the room within `reach` metres of the room; null: none. */
  near(room: Vector3, reach: number, keypoints: readonly Keypoint[], skip: (keypoint: Keypoint) => boolean): number | null {
    const at = this.toMap(room, POINT);
    let least = (reach / this.scale) ** 2;
    let found: number | null = null;
    for (let i = 0; i < keypoints.length; i++) {
      const keypoint = keypoints[i];
      if (skip(keypoint)) continue;
      const { position } = keypoint;
      const x = position[0] - at.x;
      const y = position[1] - at.y;
      const z = position[2] - this.belowEyeM - at.z;
      const square = x * x + y * y + z * z;
      if (square >= least) continue;
      found = keypoint.id;
      least = square;
    }
    return found;
  }

  /**
   * The keypoint that the ray in `ray` points at: within `radiusM` of it, or within the angle. Null: none, or all are farther than
   * `mostM` along it. `rayDistance` is how far along the ray the one found is [m of the map].
   */
  pointedAt(
    keypoints: readonly Keypoint[],
    radiusM: number,
    angle: number,
    mostM: number,
    skip: (keypoint: Keypoint) => boolean,
  ): number | null {
    const { origin, direction } = this.ray;
    let best = Infinity;
    let found: number | null = null;
    for (let i = 0; i < keypoints.length; i++) {
      const keypoint = keypoints[i];
      if (skip(keypoint)) continue;
      const { position } = keypoint;
      const x = position[0] - origin.x;
      const y = position[1] - origin.y;
      const z = position[2] - this.belowEyeM - origin.z;
      const along = x * direction.x + y * direction.y + z * direction.z;
      if (along <= 0 || along > mostM) continue;
      const aside = Math.sqrt(Math.max(0, x * x + y * y + z * z - along * along));
      if (aside > Math.max(radiusM, along * angle) || aside / along >= best) continue;
      best = aside / along;
      found = keypoint.id;
      this.rayDistance = along;
    }
    return found;
  }

  rayDistance = 0;
}

const POINT = new Vector();
const AHEAD = new Vector();
