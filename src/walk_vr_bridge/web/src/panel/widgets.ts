// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What the panel is made of. The desktop draws it as elements, the headset as a picture with places to hit. */

import type { IconName } from "./icons";

export interface Button {
  readonly kind: "button";
  readonly id: string;
  readonly label: string;
  readonly icon?: IconName;
  /** For a button that stays pressed; undefined for one that only does something. */
  readonly pressed?: boolean;
  readonly disabled?: boolean;
  readonly tone?: "primary" | "danger";
  /** Shows the icon alone; the label is still said by a screen reader. */
  readonly compact?: boolean;
  run(): void;
}

/** Buttons side by side. */
export interface Row {
  readonly kind: "row";
  readonly id: string;
  readonly buttons: readonly Button[];
}

export interface Toggle {
  readonly kind: "toggle";
  readonly id: string;
  readonly label: string;
  readonly hint?: string;
  readonly on: boolean;
  readonly disabled?: boolean;
  set(on: boolean): void;
}

/** One of a few. */
export interface Choice {
  readonly kind: "choice";
  readonly id: string;
  readonly label: string;
  readonly options: readonly { readonly value: string; readonly label: string }[];
  readonly value: string;
  readonly disabled?: boolean;
  choose(value: string): void;
}

export interface Slider {
  readonly kind: "slider";
  readonly id: string;
  readonly label: string;
  readonly hint?: string;
  /** Where the knob is, 0 to 1. */
  readonly position: number;
  /** What the value reads like at a position of the knob. */
  text(position: number): string;
  /** How far an arrow key moves the knob. */
  readonly step: number;
  readonly disabled?: boolean;
  /** While the knob moves; where it is missing, only `commit` is told. */
  input?(position: number): void;
  commit(position: number): void;
}

/** A line of the list of keypoints; when chosen, what can be done with it stands below. */
export interface Item {
  readonly kind: "item";
  readonly id: string;
  readonly number: string;
  readonly title: string;
  readonly detail: string;
  readonly tone: "plain" | "start" | "end" | "warn";
  readonly chosen: boolean;
  choose(): void;
}

/** Something to drag out of the panel into the building. */
export interface DragSource {
  readonly kind: "drag";
  readonly id: string;
  readonly label: string;
  readonly hint: string;
  readonly disabled?: boolean;
  /** What happens where there is no dragging, as with a keyboard. */
  run(): void;
}

export interface Note {
  readonly kind: "note";
  readonly id: string;
  readonly text: string;
  readonly tone: "plain" | "good" | "wait" | "warn" | "title";
}

/** A colour scale with what its ends mean. */
export interface Legend {
  readonly kind: "legend";
  readonly id: string;
  readonly low: string;
  readonly high: string;
}

/** A question answered on a scale of `count` marks. */
export interface Scale {
  readonly kind: "scale";
  readonly id: string;
  readonly question: string;
  readonly ends: readonly [string, string];
  readonly count: number;
  /** Index of the mark chosen; null: none yet. */
  readonly value: number | null;
  /** What each mark reads like for a screen reader. */
  text(index: number): string;
  choose(index: number): void;
}

/** A whole number the user can step. */
export interface Stepper {
  readonly kind: "stepper";
  readonly id: string;
  readonly label: string;
  readonly value: string;
  readonly disabled?: boolean;
  step(by: 1 | -1): void;
}

export type Widget = Button | Row | Toggle | Choice | Slider | Item | DragSource | Note | Legend | Scale | Stepper;

export interface Section {
  readonly id: string;
  readonly title: string;
  readonly widgets: readonly Widget[];
}

export type TabId = "tour" | "view" | "tune" | "walk" | "study";

export interface Tab {
  readonly id: TabId;
  readonly label: string;
  readonly icon: IconName;
}

export const TABS: readonly Tab[] = [
  { id: "tour", label: "Tour", icon: "route" },
  { id: "view", label: "View", icon: "eye" },
  { id: "tune", label: "Tune", icon: "tune" },
  { id: "walk", label: "Play", icon: "play" },
  { id: "study", label: "Study", icon: "study" },
];
