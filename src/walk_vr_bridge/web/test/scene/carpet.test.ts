// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { makeCarpet, OVER_FLOOR_M } from "../../src/scene/carpet";

describe("the carpet", () => {
  it("lies over each piece of each storey's floor, faces up and has its area", () => {
    const floors = [[0, 0, 4, 3, 0, 4, 0, 5, 3, 0.4], [1, 1, 2, 3, 3]];
    const storeys = floors.map((floor, k) => ({ name: "", floorZ: 3 * k, floor: Float32Array.from(floor) }));
    const { attributes, index } = makeCarpet(storeys);
    const at = (k: number) => [0, 1, 2].map((axis) => attributes.position!.array[3 * index!.array[k]! + axis]!);
    let area = 0;
    const heights = new Set<number>();
    for (let k = 0; k < index!.count; k += 3) {
      const [a, b, c] = [at(k), at(k + 1), at(k + 2)] as const;
      const twice = (b[0]! - a[0]!) * (c[1]! - a[1]!) - (c[0]! - a[0]!) * (b[1]! - a[1]!);
      expect(twice).toBeGreaterThan(0);
      area += twice / 2;
      heights.add(Math.round(1000 * (a[2]! - OVER_FLOOR_M)) / 1000 + 0);
    }
    expect(area).toBeCloseTo(12 + 3 + 2, 5);
    expect([...heights]).toEqual([0, 0.4, 3]);
  });

  it("is empty where nobody can walk", () => {
    expect(makeCarpet([]).index!.count).toBe(0);
  });
});
