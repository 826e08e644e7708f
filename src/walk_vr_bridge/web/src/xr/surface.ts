// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Vector3 } from "three";
import type { Overlay } from "../scene/overlay";
import type { Stage } from "../scene/stage";
import type { HandInput } from "./input";
import { entry } from "./teleport";

/** Where a hand's ray meets the building in one of its two showings. */
export interface Meeting {
  /** In the map. */
  readonly at: Vector3;
  /** Along the ray [m of the room]. */
  distance: number;
  /** How far the surface faces up: 1 is a floor, 0 a wall. */
  up: number;
}

export function makeMeeting(): Meeting {
  return { at: new Vector3(), distance: Infinity, up: 0 };
}

/** Writes into `out` what the ray meets first in this showing, behind the miniature's cut; returns whether it meets anything. */
export function meetBuilding(stage: Stage, overlay: Overlay, hand: HandInput, out: Meeting): boolean {
  const bvh = stage.models?.bvh;
  const { place } = overlay;
  if (!bvh || !place.group.visible) return false;
  const { origin, direction } = place.rayToMap(hand.ray);
  const { clip } = stage.miniature;
  const skip = overlay === stage.inMiniature && clip.active ? entry(clip.plane, origin, direction) : 0;
  const hit = bvh.cast(origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, skip);
  if (hit.distance === Infinity) return false;
  out.at.copy(origin).addScaledVector(direction, hit.distance);
  out.distance = hit.distance * place.scale;
  out.up = hit.nz;
  return true;
}

/** The same for whichever showing the ray meets first. */
export function meetNearest(stage: Stage, hand: HandInput, out: Meeting): boolean {
  const inMiniature = meetBuilding(stage, stage.inMiniature, hand, out);
  if (!meetBuilding(stage, stage.inFull, hand, OTHER)) return inMiniature;
  if (inMiniature && out.distance <= OTHER.distance) return true;
  out.at.copy(OTHER.at);
  out.distance = OTHER.distance;
  out.up = OTHER.up;
  return true;
}

const OTHER = makeMeeting();
