// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { SUS_ITEMS, susScore } from "../../src/study/sus";
import { rawTlx, TLX_PAIRS, TLX_SCALES, tlxWeights, weightedTlx, type TlxKey } from "../../src/study/tlx";

describe("SUS", () => {
  it("scores the example of Brooke (1996) with 55", () => {
    expect(susScore([5, 4, 2, 1, 2, 3, 2, 4, 5, 2])).toBe(55);
  });

  it("runs from 0 to 100, and 50 is the middle, also for what is left out", () => {
    expect(susScore([5, 1, 5, 1, 5, 1, 5, 1, 5, 1])).toBe(100);
    expect(susScore([1, 5, 1, 5, 1, 5, 1, 5, 1, 5])).toBe(0);
    expect(susScore(Array<null>(10).fill(null))).toBe(50);
  });

  it("rises by 2.5 with each step for the system, whichever item it is", () => {
    SUS_ITEMS.forEach((_, item) => {
      const answers = Array<number>(10).fill(3);
      answers[item] = item % 2 === 0 ? 4 : 2;
      expect(susScore(answers)).toBe(52.5);
    });
  });

  it.each([[[]], [Array(9).fill(3)], [Array(10).fill(0)], [Array(10).fill(6)], [Array(10).fill(2.5)]])(
    "refuses %j",
    (answers) => {
      expect(() => susScore(answers as number[])).toThrow(RangeError);
    },
  );
});

const ratings = { mental: 30, physical: 15, temporal: 60, performance: 40, effort: 40, frustration: 30 };

/** Answers to the comparisons that give these weights, found by taking the first choice that leaves a way. */
function choicesFor(wanted: Record<TlxKey, number>): TlxKey[] {
  const search = (index: number, left: Record<TlxKey, number>): TlxKey[] | null => {
    const pair = TLX_PAIRS[index];
    if (!pair) return [];
    for (const key of pair) {
      if (left[key] === 0) continue;
      const rest = search(index + 1, { ...left, [key]: left[key] - 1 });
      if (rest) return [key, ...rest];
    }
    return null;
  };
  return search(0, wanted)!;
}

describe("NASA-TLX", () => {
  it("compares each pair of the six scales once", () => {
    const names = TLX_PAIRS.map((pair) => [...pair].sort().join("-"));
    expect(new Set(names).size).toBe(15);
    expect(TLX_PAIRS.every(([a, b]) => a !== b)).toBe(true);
  });

  it("weighs ratings by how often their scale was chosen", () => {
    const weights = { mental: 3, physical: 0, temporal: 5, performance: 1, effort: 3, frustration: 3 };
    const chosen = choicesFor(weights);
    expect(tlxWeights(chosen)).toEqual(weights);
    // 30 * 3 + 15 * 0 + 60 * 5 + 40 * 1 + 40 * 3 + 30 * 3 = 640
    expect(weightedTlx(ratings, chosen)).toBeCloseTo(640 / 15, 12);
    expect(rawTlx(ratings)).toBeCloseTo(215 / 6, 12);
  });

  it("is the rating itself where all ratings are alike, whatever was chosen", () => {
    const alike = Object.fromEntries(TLX_SCALES.map(({ key }) => [key, 35])) as Record<TlxKey, number>;
    const chosen = TLX_PAIRS.map((pair, index) => pair[index % 2]!);
    expect(weightedTlx(alike, chosen)).toBeCloseTo(35, 12);
    expect(rawTlx(alike)).toBeCloseTo(35, 12);
  });

  it("refuses ratings off the marks and choices off the pair", () => {
    const chosen: (TlxKey | null)[] = TLX_PAIRS.map(([first]) => first);
    for (const mental of [-5, 101, 7, NaN]) expect(() => rawTlx({ ...ratings, mental })).toThrow("Mental demand");
    expect(() => tlxWeights(chosen.slice(1))).toThrow(RangeError);
    expect(() => tlxWeights([null, ...chosen.slice(1)])).toThrow("comparison 1");
    expect(() => tlxWeights(["effort", ...chosen.slice(1)])).toThrow("mental and physical");
  });
});
