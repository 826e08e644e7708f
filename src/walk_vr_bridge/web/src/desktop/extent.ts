// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What a view of the building is fitted to: where one walks, not the site around it. */

import { Box3, Vector3 } from "three";
import type { Stage } from "../scene/stage";

/** The walls around the floor [m]. */
const WALLS_M = 0.6;
const ROOM_HEIGHT_M = 3;

/** Returns the extent, in the map's coordinates, of the rooms that are reached and of the keypoints; else of the model. */
export function extent(stage: Stage): Box3 {
  const { building, keypoints } = stage.store.state;
  const box = new Box3();
  for (const { centre, areaM2, reason } of building?.rooms ?? []) {
    if (reason) continue;
    const half = Math.sqrt(areaM2) / 2;
    box.expandByPoint(AT.set(centre[0] - half, centre[1] - half, centre[2]));
    box.expandByPoint(AT.set(centre[0] + half, centre[1] + half, centre[2] + ROOM_HEIGHT_M));
  }
  for (const { position } of keypoints) box.expandByPoint(AT.set(position[0], position[1], position[2]));
  return box.isEmpty() ? stage.bounds.clone() : box.expandByScalar(WALLS_M).intersect(stage.bounds);
}

const AT = new Vector3();
