// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Edits as the planner takes them: the message, and the table of changes (docs/topics.md). */

import type { Quat, Vec3 } from "./state";

export const EVENT = { KEEP_ALIVE: 0, POSE_UPDATE: 1, MENU_SELECT: 2, MOUSE_DOWN: 4, MOUSE_UP: 5 } as const;

export const CHANGE = {
  insert: 1,
  remove: 2,
  reorder: 3,
  lock: 4,
  unlock: 5,
  start: 6,
  end: 7,
  freeEnd: 8,
  dwell: 9,
  lookAt: 10,
  undo: 13,
  redo: 14,
  insertNear: 15,
} as const;

export type ChangeName = keyof typeof CHANGE;

export interface Edit {
  readonly event: keyof typeof EVENT;
  readonly change: ChangeName | null;
  /** Identity; null where none is meant. */
  readonly keypoint: number | null;
  readonly position: Vec3 | null;
  readonly quat: Quat | null;
  /** For reorder, dwell, and insert half-way. */
  readonly argument: string;
  readonly lookAt: Vec3 | null;
}

const HERE: Quat = [0, 0, 0, 1];
const ORIGIN: Vec3 = [0, 0, 0];

/** Returns the message; `label` rises and comes back in the answer. */
export function editMessage(edit: Edit, label: number): Record<string, unknown> {
  const [qx, qy, qz, qw] = edit.quat ?? HERE;
  return {
    header: { frame_id: "map", stamp: { sec: Math.floor(label / 1e9), nanosec: label % 1e9 } },
    marker_name: edit.keypoint === null ? "" : String(edit.keypoint),
    control_name: edit.argument,
    event_type: EVENT[edit.event],
    menu_entry_id: edit.change === null ? 0 : CHANGE[edit.change],
    pose: { position: xyz(edit.position ?? ORIGIN), orientation: { x: qx, y: qy, z: qz, w: qw } },
    mouse_point: xyz(edit.lookAt ?? ORIGIN),
    mouse_point_valid: edit.lookAt !== null,
  };
}

function xyz([x, y, z]: Vec3): { x: number; y: number; z: number } {
  return { x, y, z };
}

const BLANK: Edit = {
  event: "MENU_SELECT",
  change: null,
  keypoint: null,
  position: null,
  quat: null,
  argument: "",
  lookAt: null,
};

export function change(name: ChangeName, keypoint: number | null, more: Partial<Edit> = {}): Edit {
  return { ...BLANK, change: name, keypoint, ...more };
}

export function gesture(event: "MOUSE_DOWN" | "POSE_UPDATE" | "MOUSE_UP" | "KEEP_ALIVE", keypoint: number): Edit {
  return { ...BLANK, event, keypoint };
}

const NOT_REPEATABLE: ReadonlySet<ChangeName | null> = new Set(["insert", "insertNear", "undo", "redo", null]);

/** Whether doing it twice ends as doing it once: such an edit is simply sent again after a lost connection. */
export function repeatable(edit: Edit): boolean {
  if (edit.event !== "MENU_SELECT") return edit.event === "MOUSE_UP";
  if (edit.change === "reorder") return !["earlier", "later"].includes(edit.argument);
  return !NOT_REPEATABLE.has(edit.change);
}

/** What the edit is, for a sentence such as "… was not confirmed". */
export function describe(edit: Edit): string {
  const which = edit.keypoint === null ? "" : ` of keypoint ${edit.keypoint}`;
  if (edit.event !== "MENU_SELECT") return `the move${which}`;
  const names: Record<ChangeName, string> = {
    insert: "the new keypoint",
    remove: "the deletion",
    reorder: "the new order",
    lock: "the lock",
    unlock: "the unlocking",
    start: "the choice of the start",
    end: "the choice of the end",
    freeEnd: "the release of the end",
    dwell: "the stay",
    lookAt: "the look direction",
    undo: "the undo",
    redo: "the redo",
    insertNear: "the new keypoint",
  };
  const name = edit.change === null ? "the edit" : names[edit.change];
  return NOT_REPEATABLE.has(edit.change) ? name : name + which;
}
