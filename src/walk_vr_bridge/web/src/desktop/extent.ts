// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What a view of the building is fitted to: where one walks, not the site around it. */

import { Box3, Vector3 } from "three";
import type { BuildingState, Keypoint } from "../client/state";

/** The walls around the floor [m]. */
const WALLS_M = 0.6;
const ROOM_HEIGHT_M = 3;

/** Returns the extent, in the map's coordinates, of the floors that one walks on and of the keypoints; else all of the model. */
export function extent(building: BuildingState | null, keypoints: readonly Keypoint[], bounds: Box3): Box3 {
  const box = new Box3();
  for (const { floor } of building?.storeys ?? []) {
    for (let at = 0; at < floor.length; at += 5) {
      box.expandByPoint(AT.set(floor[at], floor[at + 1], floor[at + 4]));
      box.expandByPoint(AT.set(floor[at + 2], floor[at + 3], floor[at + 4] + ROOM_HEIGHT_M));
    }
  }
  for (const { position } of keypoints) box.expandByPoint(AT.set(position[0], position[1], position[2]));
  return box.isEmpty() ? bounds.clone() : box.expandByScalar(WALLS_M).intersect(bounds);
}

const AT = new Vector3();
