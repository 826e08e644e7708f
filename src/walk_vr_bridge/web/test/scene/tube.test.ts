// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { BufferAttribute } from "three";
import { EDGES, MAX_RINGS, PathTube } from "../../src/scene/tube";

function along(tube: PathTube, ring: number): number[] {
  const at = ring * EDGES * 3;
  return Array.from(tube.geometry.getAttribute("aAlong").array.slice(at, at + 3));
}

const dot = (a: number[], b: number[]): number => a.reduce((sum, value, i) => sum + value * b[i], 0);

describe("the path's tube", () => {
  it("knows the way at each of its rings, as a unit vector", () => {
    const tube = new PathTube();
    tube.setPath(Float32Array.from([0, 0, 0, 1, 1, 0, 2, 2, 1, 2, 3, 2]), 4);
    const ways = [[1, 1, 0], [2, 2, 1], [1, 2, 2], [0, 1, 1]];
    ways.forEach((way, ring) => {
      expect(dot(along(tube, ring), along(tube, ring))).toBeCloseTo(1, 5);
      expect(dot(along(tube, ring), way)).toBeCloseTo(Math.hypot(...way), 5);
    });
  });

  it("has two edges at one place of the path", () => {
    const tube = new PathTube();
    tube.setPath(Float32Array.from([0, 0, 0, 1, 2, 3]), 2);
    expect(Array.from(tube.geometry.getAttribute("position").array.slice(6, 12))).toEqual([1, 2, 3, 1, 2, 3]);
    expect(Array.from(tube.geometry.getAttribute("aEdge").array.slice(0, 4))).toEqual([-1, 1, -1, 1]);
  });

  it("keeps its way where the path stands still", () => {
    const tube = new PathTube();
    tube.setPath(Float32Array.from([0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0]), 4);
    for (let ring = 0; ring < 4; ring++) expect(along(tube, ring)).toEqual([1, 0, 0]);
  });

  it("hands the graphics card no more than the rings in use", () => {
    const tube = new PathTube();
    tube.setPath(Float32Array.from([0, 0, 0, 1, 0, 0]), 2);
    const { updateRanges } = tube.geometry.getAttribute("position") as BufferAttribute;
    expect(updateRanges).toEqual([{ start: 0, count: 12 }]);
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
    expect(tube.geometry.drawRange.count).toBe((MAX_RINGS - 1) * 6);
  });

  it("shows nothing of an empty path", () => {
    const tube = new PathTube();
    tube.setPath(new Float32Array(0), 0);
    expect(tube.geometry.drawRange.count).toBe(0);
  });
});
