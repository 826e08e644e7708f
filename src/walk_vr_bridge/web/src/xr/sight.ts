// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Vector3 } from "three";
import type { Bvh } from "../scene/bvh";

/** A hand's breadth: so far before a wall things stay [m]. */
export const BEFORE_WALL_M = 0.1;
/** Things come no nearer to the eye than this [m]. */
const NEAREST_M = 0.3;

/** Whether no wall stands between the eye and a place of the room, nor so far behind it [m]. No building hides nothing. */
export function inSight(walls: Bvh | undefined, eye: Vector3, at: Vector3, behindM = 0): boolean {
  const most = STEP.subVectors(at, eye).length() + behindM;
  return !walls || look(walls, eye, STEP.normalize(), most) === Infinity;
}

/** Moves a place of the room towards the eye until it is before the wall that hides it; returns it. */
export function bringIntoSight(walls: Bvh | undefined, eye: Vector3, at: Vector3): Vector3 {
  const way = STEP.subVectors(at, eye).length();
  const wall = walls ? look(walls, eye, STEP.normalize(), way + BEFORE_WALL_M) : Infinity;
  const seen = Math.max(NEAREST_M, wall - BEFORE_WALL_M);
  return seen < way ? at.copy(eye).addScaledVector(STEP, seen) : at;
}

/** The way to the first wall in a direction of the room; Infinity: none within `most` [m]. */
function look(walls: Bvh, eye: Vector3, direction: Vector3, most: number): number {
  return walls.cast(eye.x, -eye.z, eye.y, direction.x, -direction.z, direction.y, 0, most).distance;
}

const STEP = new Vector3();
