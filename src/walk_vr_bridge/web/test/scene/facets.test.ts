// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { facetsOf } from "../../src/scene/facets";
import type { BuildingMesh, Part } from "../../src/scene/glb";

const CORNERS = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1];
const CUBE = [0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7];

function cube(parts: Part[]): BuildingMesh {
  return { group: "structure", storey: 0, parts, positions: Float32Array.from(CORNERS), indices: Uint32Array.from(CUBE) };
}

function part(first: number, count: number): Part {
  return { name: "part", kind: "", first, count } as Part;
}

describe("facets", () => {
  it("keep every triangle, the same way round", () => {
    const { source, indices } = facetsOf(cube([part(0, CUBE.length)]));
    for (let i = 0; i < CUBE.length; i += 3) {
      const corners = [0, 1, 2].map((k) => source[indices[i + k]]);
      const turn = corners.indexOf(CUBE[i]);
      expect([0, 1, 2].map((k) => corners[(turn + k) % 3])).toEqual(CUBE.slice(i, i + 3));
    }
  });

  it("have the normal of each triangle at its last corner, and double few corners", () => {
    const { source, indices, normals } = facetsOf(cube([part(0, CUBE.length)]));
    for (let i = 0; i < CUBE.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => CORNERS.slice(3 * CUBE[i + k], 3 * CUBE[i + k] + 3));
      const [u, v] = [b.map((x, k) => x - a[k]), c.map((x, k) => x - a[k])];
      const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      const kept = Array.from(normals.slice(3 * indices[i + 2], 3 * indices[i + 2] + 3)).map((x) => (x - 128) / 127);
      kept.forEach((x, k) => expect(x).toBeCloseTo(cross[k], 6));
    }
    expect(source.length).toBeLessThan(12);
  });

  it("share no last corner between parts, which may have other colours", () => {
    const { indices } = facetsOf(cube([part(0, 3), part(3, CUBE.length - 3)]));
    const of = (from: number, to: number): Set<number> => new Set(Array.from(indices.slice(from, to)).filter((_, i) => i % 3 === 2));
    const [first, others] = [of(0, 3), of(3, CUBE.length)];
    expect([...first].filter((corner) => others.has(corner))).toEqual([]);
  });
});
