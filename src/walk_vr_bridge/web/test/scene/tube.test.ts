// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { MAX_RINGS, PathTube, SIDES } from "../../src/scene/tube";

function offsets(tube: PathTube, ring: number): number[][] {
  const array = tube.geometry.getAttribute("aOffset").array;
  const at = (side: number): number => (ring * SIDES + side) * 3;
  return Array.from({ length: SIDES }, (_, side) => Array.from(array.slice(at(side), at(side) + 3)));
}

const dot = (a: number[], b: number[]): number => a.reduce((sum, value, i) => sum + value * b[i], 0);

describe("the path's tube", () => {
  it("has rings across the way, of unit length", () => {
    const tube = new PathTube();
    tube.setPath(Float32Array.from([0, 0, 0, 1, 1, 0, 2, 2, 1, 2, 3, 2]), 4);
    const ways = [[1, 1, 0], [2, 2, 1], [1, 2, 2], [0, 1, 1]];
    ways.forEach((way, ring) => {
      for (const offset of offsets(tube, ring)) {
        expect(dot(offset, offset)).toBeCloseTo(1, 5);
        expect(dot(offset, way)).toBeCloseTo(0, 5);
      }
    });
  });

  it("does not twist where the way goes straight up", () => {
    const tube = new PathTube();
    tube.setPath(Float32Array.from([0, 0, 0, 1, 0, 0, 1, 0, 1, 1, 0, 2, 2, 0, 2]), 5);
    for (let ring = 1; ring < 5; ring++) expect(dot(offsets(tube, ring)[0], offsets(tube, ring - 1)[0])).toBeGreaterThan(0.99);
  });

  it("never grows its buffers: a long path is shown by fewer rows, its ends kept", () => {
    const tube = new PathTube();
    const before = tube.geometry.getAttribute("position").array;
    const count = 5000;
    tube.setPath(Float32Array.from({ length: 3 * count }, (_, i) => (i % 3 === 0 ? i / 3 : 0)), count);
    expect(tube.geometry.getAttribute("position").array).toBe(before);
    expect(tube.rings).toBe(MAX_RINGS);
    expect(tube.rowOf[0]).toBe(0);
    expect(tube.rowOf[MAX_RINGS - 1]).toBe(count - 1);
    expect(tube.geometry.drawRange.count).toBe((MAX_RINGS - 1) * SIDES * 6);
  });

  it("shows nothing of an empty path", () => {
    const tube = new PathTube();
    tube.setPath(new Float32Array(0), 0);
    expect(tube.geometry.drawRange.count).toBe(0);
  });
});
