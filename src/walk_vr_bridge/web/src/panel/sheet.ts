// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The headset's picture of the panel: its size, what it is made of, and what is hit on it [px of the texture]. */

import type { IconName } from "./icons";

export const WIDTH = 1024;
export const HEIGHT = 1536;
export const TABS_HEIGHT = 128;
export const PAD = 44;
/** Text sizes; nothing is smaller than the last, which is still read at arm's length on a sheet 0.5 m wide. */
export const SIZE = { title: 34, body: 32, small: 26 } as const;

/** How a zone is drawn. */
export type Look =
  | "tab"
  | "heading"
  | "text"
  | "button"
  | "segment"
  | "toggle"
  | "slider"
  | "item"
  | "drag"
  | "legend"
  | "mark"
  | "value";

export interface Zone {
  /** The same from one layout to the next: what is hovered or held is found again by it. */
  readonly key: string;
  readonly look: Look;
  readonly x: number;
  readonly y: number;
  readonly w: number;
  readonly h: number;
  readonly lines: readonly string[];
  readonly detail?: string;
  readonly icon?: IconName;
  readonly tone?: string;
  readonly on?: boolean;
  readonly disabled?: boolean;
  /** The number of an item; where a slider's knob is. */
  readonly number?: string;
  readonly position?: number;
  press?(): void;
  /** For sliders: `done` when it is let go. */
  slide?(position: number, done: boolean): void;
  /** What the value reads like at a position. */
  text?(position: number): string;
}

export interface Layout {
  readonly zones: readonly Zone[];
  /** How far the body reaches, without scrolling [px]. */
  readonly bottom: number;
}

/** Width of a text at a size [px]. */
export type Measure = (text: string, size: number) => number;

/** The zone at a place of the picture that can be used, or null. Tabs stay; the rest moves with the scrolling. */
export function zoneAt(layout: Layout, x: number, y: number, scroll: number): Zone | null {
  for (const zone of layout.zones) {
    const top = zone.look === "tab" ? zone.y : zone.y - scroll;
    if (zone.look !== "tab" && y < TABS_HEIGHT) continue;
    const inside = x >= zone.x && x < zone.x + zone.w && y >= top && y < top + zone.h;
    if (inside && !zone.disabled && (zone.press || zone.slide || zone.look === "drag")) return zone;
  }
  return null;
}

/** A slider's travel begins and ends this far from its zone's edges [px]. */
export const SLIDER_INSET = 20;

export function slideAt(zone: Zone, x: number): number {
  return Math.min(1, Math.max(0, (x - zone.x - SLIDER_INSET) / (zone.w - 2 * SLIDER_INSET)));
}
