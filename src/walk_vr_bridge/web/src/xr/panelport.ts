// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { type Object3D, Vector2, Vector3 } from "three";
import type { Hand } from "../client/state";
import type { Ray } from "../scene/place";

/** What a press on the panel means for the hand: nothing there, the panel has it, or a new keypoint is dragged out of it. */
export type PanelPress = "none" | "pressed" | "add";

/** The panel as hands see it: a sheet in the room that faces its own +z, its origin in its middle. */
export interface PanelPort {
  readonly group: Object3D;
  readonly widthM: number;
  readonly heightM: number;
  /** The ray of a hand is at a place of the sheet: x right, y down, 0 to 1; null: it is not on the sheet any more. */
  point(hand: Hand, at: Vector2 | null): void;
  press(hand: Hand, at: Vector2): PanelPress;
  release(hand: Hand, at: Vector2 | null): void;
  scroll(hand: Hand, amount: number): void;
  /** Once a frame: draws itself anew if it has changed. */
  update(seconds: number): void;
}

/** Where a ray meets the panel: writes the place into `out` and returns the distance; Infinity: it misses. */
export function meetPanel(panel: PanelPort, ray: Ray, out: Vector2): number {
  const { group } = panel;
  if (!group.visible) return Infinity;
  group.worldToLocal(FROM.copy(ray.origin));
  group.worldToLocal(TO.copy(ray.origin).add(ray.direction)).sub(FROM);
  // Only the front can be used: from behind one would press what one cannot read.
  if (TO.z >= 0 || FROM.z <= 0) return Infinity;
  const along = -FROM.z / TO.z;
  const x = (FROM.x + along * TO.x) / panel.widthM + 0.5;
  const y = 0.5 - (FROM.y + along * TO.y) / panel.heightM;
  if (x < 0 || x > 1 || y < 0 || y > 1) return Infinity;
  out.set(x, y);
  return along;
}

const FROM = new Vector3();
const TO = new Vector3();
