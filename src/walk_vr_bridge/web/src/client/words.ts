// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import type { Keypoint } from "./state";

/** Reasons come as clauses; where they stand alone they begin and end like a sentence. */
export function sentence(reason: string): string {
  const text = reason.charAt(0).toUpperCase() + reason.slice(1);
  return /[.!?…]$/.test(text) ? text : `${text}.`;
}

/** The planner names keypoints by their identity, the page shows their places in the tour: says it as the page does. */
export function byPlace(reason: string, keypoints: readonly Pick<Keypoint, "id">[]): string {
  const place = (identity: string): string => {
    const index = keypoints.findIndex(({ id }) => id === Number(identity));
    return index < 0 ? identity : String(index + 1);
  };
  return reason.replace(NAMED, (named) => named.replace(/\d+/g, place));
}

/** "keypoint 12", "keypoints 3 and 12"; not those that are numbered as they were suggested. */
const NAMED = /(?<!suggested )\bkeypoint(?: \d+|s \d+ and \d+)\b/gi;
