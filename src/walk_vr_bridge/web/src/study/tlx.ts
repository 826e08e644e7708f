// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The NASA Task Load Index: six scales, fifteen comparisons and both scores (`hart1988`, `hart2006`). */

export interface TlxScale {
  readonly key: TlxKey;
  readonly title: string;
  readonly question: string;
  /** What the ends of the scale say; that of performance runs from good to poor. */
  readonly ends: readonly [string, string];
}

export type TlxKey = "mental" | "physical" | "temporal" | "performance" | "effort" | "frustration";

const LOW_TO_HIGH: readonly [string, string] = ["Very low", "Very high"];

export const TLX_SCALES: readonly TlxScale[] = [
  { key: "mental", title: "Mental demand", question: "How mentally demanding was the task?", ends: LOW_TO_HIGH },
  { key: "physical", title: "Physical demand", question: "How physically demanding was the task?", ends: LOW_TO_HIGH },
  {
    key: "temporal",
    title: "Temporal demand",
    question: "How hurried or rushed was the pace of the task?",
    ends: LOW_TO_HIGH,
  },
  {
    key: "performance",
    title: "Performance",
    question: "How successful were you in accomplishing what you were asked to do?",
    ends: ["Perfect", "Failure"],
  },
  {
    key: "effort",
    title: "Effort",
    question: "How hard did you have to work to accomplish your level of performance?",
    ends: LOW_TO_HIGH,
  },
  {
    key: "frustration",
    title: "Frustration",
    question: "How insecure, discouraged, irritated, stressed, and annoyed were you?",
    ends: LOW_TO_HIGH,
  },
];

/** The scale has 21 marks: 0 to 100 in fives. */
export const TLX_STEP = 5;
export const TLX_MAX = 100;

export type TlxRatings = Readonly<Record<TlxKey, number>>;
export type TlxPair = readonly [TlxKey, TlxKey];

/** All fifteen pairs of scales; a participant says which of the two contributed more to the workload. */
export const TLX_PAIRS: readonly TlxPair[] = TLX_SCALES.flatMap((first, index) =>
  TLX_SCALES.slice(index + 1).map((second): TlxPair => [first.key, second.key]),
);

/** Returns the raw index, 0 to 100: the mean of the six ratings (`hart2006`). @throws RangeError for a bad rating. */
export function rawTlx(ratings: TlxRatings): number {
  checkRatings(ratings);
  return TLX_SCALES.reduce((sum, scale) => sum + ratings[scale.key], 0) / TLX_SCALES.length;
}

/**
 * Returns how often each scale was chosen, 0 to 5; they add up to 15.
 *
 * @param chosen one key per pair, in the order of TLX_PAIRS.
 * @throws RangeError where a pair has no answer, or one that is not of the pair.
 */
export function tlxWeights(chosen: readonly (TlxKey | null)[]): Record<TlxKey, number> {
  if (chosen.length !== TLX_PAIRS.length) {
    throw new RangeError(`the TLX has ${TLX_PAIRS.length} comparisons, but there are ${chosen.length} answers`);
  }
  const weights: Record<TlxKey, number> = {
    mental: 0,
    physical: 0,
    temporal: 0,
    performance: 0,
    effort: 0,
    frustration: 0,
  };
  TLX_PAIRS.forEach((pair, index) => {
    const key = chosen[index];
    if (!key || !pair.includes(key)) {
      throw new RangeError(`TLX comparison ${index + 1} is between ${pair.join(" and ")}, not ${String(key)}`);
    }
    weights[key] += 1;
  });
  return weights;
}

/** Returns the weighted index, 0 to 100: ratings times weights, over 15 (`hart1988`). @throws RangeError, see above. */
export function weightedTlx(ratings: TlxRatings, chosen: readonly (TlxKey | null)[]): number {
  checkRatings(ratings);
  const weights = tlxWeights(chosen);
  return TLX_SCALES.reduce((sum, { key }) => sum + ratings[key] * weights[key], 0) / TLX_PAIRS.length;
}

function checkRatings(ratings: TlxRatings): void {
  for (const { key, title } of TLX_SCALES) {
    const rating = ratings[key];
    if (!Number.isInteger(rating) || rating < 0 || rating > TLX_MAX || rating % TLX_STEP !== 0) {
      throw new RangeError(`TLX rating of ${title} is 0 to ${TLX_MAX} in steps of ${TLX_STEP}, not ${rating}`);
    }
  }
}
