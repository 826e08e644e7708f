// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What is under the pointer: the floor that a keypoint would stand on. All in the map's coordinates. */

import { Vector3 } from "three";
import type { Vec3 } from "../client/state";
import { makeRay } from "../scene/place";
import type { Stage } from "../scene/stage";

/** A floor this far above the level one drags on is stepped up to [m]; stairs and ramps are followed by it. */
const UP_M = 0.6;
const DOWN_M = 3;
/** A hit is drawn back a little, so that the floor in front of a wall is found and not the wall's own top. */
const BACK_M = 0.05;

export class Ground {
  private readonly ray = makeRay();

  constructor(private readonly stage: Stage) {}

  /** The eye of a walker on the floor under the pointer; null where there is none. */
  eyeUnder(clientX: number, clientY: number): Vec3 | null {
    const hit = this.hit(clientX, clientY);
    if (!hit) return null;
    const floorZ = this.floorBelow(hit.x, hit.y, hit.z + 0.1, 50);
    return floorZ === null ? null : [hit.x, hit.y, floorZ + this.stage.eyeHeightM];
  }

  /** The surface under the pointer itself, for what is looked at. */
  surfaceUnder(clientX: number, clientY: number): Vec3 | null {
    const hit = this.hit(clientX, clientY);
    return hit ? [hit.x, hit.y, hit.z] : null;
  }

  /** Where a keypoint that was at the height `z` of the eye is dragged to: along its level, up and down with the floor. */
  dragged(clientX: number, clientY: number, z: number, belowM: number): Vec3 | null {
    const ray = this.mapRay(clientX, clientY);
    const along = (z - belowM - ray.origin.z) / ray.direction.z;
    if (!(along > 0) || along > 1e4) return null;
    const [x, y] = [ray.origin.x + along * ray.direction.x, ray.origin.y + along * ray.direction.y];
    const eye = this.stage.eyeHeightM;
    const floorZ = this.floorBelow(x, y, z - eye + UP_M, UP_M + DOWN_M);
    return [x, y, floorZ === null ? z : floorZ + eye];
  }

  private mapRay(clientX: number, clientY: number): { origin: Vector3; direction: Vector3 } {
    const { view } = this.stage;
    return this.stage.overlayInView().place.rayToMap(view.pointerRay(clientX, clientY, this.ray));
  }

  private hit(clientX: number, clientY: number): Vector3 | null {
    const bvh = this.stage.models?.bvh;
    if (!bvh) return null;
    const { origin, direction } = this.mapRay(clientX, clientY);
    const least = this.cutDistance(origin, direction);
    const { distance } = bvh.cast(origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, least);
    if (!Number.isFinite(distance)) return null;
    return HIT.copy(direction)
      .multiplyScalar(distance - BACK_M)
      .add(origin);
  }

  /** Nothing before the cut is seen: rays begin there. */
  private cutDistance(origin: Vector3, direction: Vector3): number {
    const { clip } = this.stage.miniature;
    if (this.stage.mode === "inside" || !clip.active) return 0;
    const { normal, constant } = clip.plane;
    const height = normal.dot(origin) + constant;
    const slope = normal.dot(direction);
    return height < 0 && slope > 0 ? -height / slope : 0;
  }

  private floorBelow(x: number, y: number, fromZ: number, most: number): number | null {
    const bvh = this.stage.models?.bvh;
    const distance = bvh?.cast(x, y, fromZ, 0, 0, -1, 0, most).distance ?? Infinity;
    return Number.isFinite(distance) ? fromZ - distance : null;
  }
}

const HIT = new Vector3();
