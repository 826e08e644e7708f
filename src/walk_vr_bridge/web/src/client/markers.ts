// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The keypoints of a `keypoint_markers` message: arrows, those left out, and the marks about them. */

import { fields, finite, list, MessageError, point, stamp, unitQuat, whole, words, type Fields } from "./check";
import type { Keypoint, Vec3 } from "./state";

export interface KeypointsMessage {
  readonly revision: string;
  /** In tour order; those that the tour leaves out stand where they are in the list. */
  readonly keypoints: readonly Keypoint[];
}

const ADD = 0;
const DELETE_ALL = 3;
/** Seconds to stand at a keypoint, as the mark's text says it. */
const DWELL = /^([0-9.e+-]+) s$/;

interface Marks {
  readonly unreachable: Map<number, string>;
  readonly lookAt: Map<number, Vec3>;
  readonly dwellS: Map<number, number>;
  readonly locked: Set<number>;
  start: number | null;
  end: number | null;
}

/** Returns the keypoints. @throws MessageError where the message is not sound. */
export function keypointsFromMarkers(message: unknown): KeypointsMessage {
  const markers = list(fields(message, "keypoint_markers").markers, "markers").map((one) => fields(one, "marker"));
  const first = markers[0];
  if (!first) throw new MessageError("keypoint_markers has no markers; an empty set is one DELETEALL");
  const revision = stamp(fields(first.header, "header").stamp, "stamp");
  if (first.action === DELETE_ALL) return { revision, keypoints: [] };
  const shown = markers.filter((marker) => marker.action === ADD);
  const marks = marksOf(shown);
  const keypoints = shown.filter((marker) => marker.ns === "keypoints").map((marker) => keypointOf(marker, marks));
  if (new Set(keypoints.map(({ id }) => id)).size !== keypoints.length) {
    throw new MessageError("two keypoints have the same identity");
  }
  return { revision, keypoints };
}

function keypointOf(marker: Fields, marks: Marks): Keypoint {
  const id = whole(marker.id, "marker.id");
  const pose = fields(marker.pose, "pose");
  return {
    id,
    position: point(pose.position, "position"),
    quat: unitQuat(pose.orientation, "orientation"),
    label: words(marker.text, "marker.text"),
    locked: marks.locked.has(id),
    start: marks.start === id,
    end: marks.end === id,
    dwellS: marks.dwellS.get(id) ?? null,
    lookAt: marks.lookAt.get(id) ?? null,
    unreachable: marks.unreachable.get(id) ?? "",
    pending: false,
  };
}

function marksOf(markers: readonly Fields[]): Marks {
  const marks: Marks = {
    unreachable: new Map(),
    lookAt: new Map(),
    dwellS: new Map(),
    locked: new Set(),
    start: null,
    end: null,
  };
  for (const marker of markers) {
    const id = whole(marker.id, "marker.id");
    if (marker.ns === "unreachable") marks.unreachable.set(id, words(marker.text, "reason"));
    else if (marker.ns === "look_at") marks.lookAt.set(id, point(fields(marker.pose, "pose").position, "look_at"));
    else if (marker.ns === "dwell") marks.dwellS.set(id, dwell(words(marker.text, "dwell")));
    else if (marker.ns === "locked") marks.locked.add(id);
    else if (marker.ns === "start") marks.start = id;
    else if (marker.ns === "end") marks.end = id;
  }
  return marks;
}

function dwell(mark: string): number {
  const seconds = DWELL.exec(mark)?.[1];
  if (seconds === undefined) throw new MessageError(`a dwell reads like "2.5 s", not "${mark.slice(0, 40)}"`);
  return finite(Number(seconds), "dwell");
}
