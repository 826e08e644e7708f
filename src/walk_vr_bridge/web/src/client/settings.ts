// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** This browser's settings, kept over visits. */

import type { SettingsState } from "./state";
import { DEFAULT_SETTINGS } from "./store";

const KEY = "walk.settings";

/** Which values a text setting may have; what was stored by another version is not trusted. */
export const SETTING_VALUES = {
  surface: ["building", "transparent"],
  map: ["none", "obstacle", "distance", "visibility", "importance"],
  pathColour: ["plain", "speed", "clearance", "height", "collisions"],
  playbackPlace: ["miniature", "ride"],
  hand: ["left", "right"],
} as const;

/** Returns the stored settings, the default in the place of each that is missing or unknown. */
export function storedSettings(storage: Storage): SettingsState {
  let stored: Record<string, unknown>;
  try {
    stored = (JSON.parse(storage.getItem(KEY) ?? "{}") ?? {}) as Record<string, unknown>;
  } catch {
    stored = {};
  }
  const kept = Object.entries(DEFAULT_SETTINGS).map(([name, otherwise]) => {
    const value = stored[name];
    const allowed = (SETTING_VALUES as Record<string, readonly unknown[]>)[name] ?? [true, false];
    return [name, allowed.includes(value) ? value : otherwise];
  });
  return Object.fromEntries(kept) as unknown as SettingsState;
}

export function keepSettings(storage: Storage, settings: SettingsState): void {
  storage.setItem(KEY, JSON.stringify(settings));
}
