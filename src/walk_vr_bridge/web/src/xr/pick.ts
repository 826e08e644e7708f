// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** What a hand is at: near things first, then what its ray points at. */

import { Plane, Vector3 } from "three";
import type { Keypoint } from "../client/state";
import type { Overlay } from "../scene/overlay";
import type { Stage } from "../scene/stage";
import type { HandInput } from "./input";

/** Within this distance the hand itself takes hold [m]. */
export const NEAR_M = 0.06;
/** Half the opening of the ray's cone [rad], and how far it reaches in the room [m]. */
const RAY_ANGLE = 0.035;
const RAY_REACH_M = 25;

export interface Pick {
  id: number | null;
  overlay: Overlay | null;
  near: boolean;
  /** Along the ray [m of the room]. */
  distance: number;
}

export function makePick(): Pick {
  return { id: null, overlay: null, near: false, distance: Infinity };
}

/** Finds the keypoint a hand is at; writes into `out`, allocates nothing. */
export function pickKeypoint(stage: Stage, hand: HandInput, out: Pick): Pick {
  const { keypoints } = stage.store.state;
  out.id = null;
  out.overlay = null;
  out.distance = Infinity;
  for (let i = 0; i < stage.overlays.length; i++) {
    const overlay = stage.overlays[i];
    if (!overlay.place.group.visible) continue;
    const id = overlay.place.near(hand.tip, NEAR_M, keypoints, skip(stage, overlay));
    if (id === null) continue;
    out.id = id;
    out.overlay = overlay;
    out.near = true;
    out.distance = 0;
    return out;
  }
  for (let i = 0; i < stage.overlays.length; i++) pickByRay(stage, hand, stage.overlays[i], keypoints, out);
  return out;
}

function pickByRay(stage: Stage, hand: HandInput, overlay: Overlay, keypoints: readonly Keypoint[], out: Pick): void {
  const { place } = overlay;
  if (!place.group.visible) return;
  const { scale } = place;
  const ray = place.rayToMap(hand.ray);
  const id = place.pointedAt(keypoints, overlay.size, RAY_ANGLE, RAY_REACH_M / scale, skip(stage, overlay));
  if (id === null) return;
  const distance = place.rayDistance * scale;
  if (distance >= out.distance) return;
  if (overlay === stage.inFull && hidden(stage, ray.origin, ray.direction, place.rayDistance - overlay.size)) return;
  out.id = id;
  out.overlay = overlay;
  out.near = false;
  out.distance = distance;
}

/** At full scale a wall hides what is behind it from the ray, as from the eye. */
function hidden(stage: Stage, from: Vector3, along: Vector3, most: number): boolean {
  const bvh = stage.models?.bvh;
  if (!bvh) return false;
  return bvh.cast(from.x, from.y, from.z, along.x, along.y, along.z, 0.05, most).distance < Infinity;
}

/** What is cut away in the miniature cannot be grabbed there. */
function skip(stage: Stage, overlay: Overlay): (keypoint: Keypoint) => boolean {
  const { clip } = stage.miniature;
  if (overlay !== stage.inMiniature || !clip.active) return never;
  cut.plane = clip.plane;
  cut.lowerM = stage.eyeHeightM - 0.1;
  return cutAway;
}

const cut = { plane: new Plane(), lowerM: 0 };
const never = (): boolean => false;
/** As `Clip.keeps`, by the keypoint's foot; numbers that are handed over would be put on the heap, for each keypoint in each frame. */
function cutAway({ position }: Keypoint): boolean {
  const { normal, constant } = cut.plane;
  return normal.x * position[0] + normal.y * position[1] + normal.z * (position[2] - cut.lowerM) + constant < 0;
}
