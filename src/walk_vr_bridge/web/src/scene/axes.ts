// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { Group } from "three";

/**
 * Returns the one node that turns the map's axes (z up) into those of the headset (y up): (x, y, z) → (x, z, −y).
 * Everything that belongs to the building hangs under it and speaks the map's coordinates.
 */
export function makeWorld(): Group {
  const world = new Group();
  world.name = "world";
  world.quaternion.set(-Math.SQRT1_2, 0, 0, Math.SQRT1_2);
  world.updateMatrixWorld(true);
  return world;
}

/** Heading [rad] about the map's z of a quaternion xyzw whose x axis looks ahead. */
export function headingOf(x: number, y: number, z: number, w: number): number {
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}
