// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { BuildingMesh } from "../../src/scene/glb";
import { buildBvh } from "../../src/scene/model";
import { readTopology } from "../../src/scene/topology";

const CORNERS = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1];
const CUBE = [0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7];

function mesh(indices: number[]): BuildingMesh {
  const parts = [{ name: "part", kind: "", first: 0, count: indices.length }];
  return { group: "structure", storey: 0, parts, positions: Float32Array.from(CORNERS), indices: Uint32Array.from(indices) };
}

function volume({ positions: p, indices }: BuildingMesh): number {
  let sum = 0;
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => Array.from(p.slice(3 * indices[i + k], 3 * indices[i + k] + 3)));
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

describe("what triangles make", () => {
  it("finds a cube to be solid, with its twelve edges and none of the diagonals", () => {
    const { solid, edges } = readTopology(mesh(CUBE), 0);
    expect(Array.from(solid)).toEqual(Array(8).fill(1));
    expect(edges.length / 6).toBe(12);
  });

  it("turns a solid that is inside out", () => {
    const inside = mesh(CUBE.map((_, i) => CUBE[i - (i % 3) + [1, 0, 2][i % 3]]));
    expect(volume(inside)).toBeCloseTo(-1, 9);
    readTopology(inside, 0);
    expect(volume(inside)).toBeCloseTo(1, 9);
  });

  it("holds a cube without a lid to be no solid, so that it is never filled", () => {
    expect(Array.from(readTopology(mesh(CUBE.slice(6)), 0).solid)).toEqual(Array(8).fill(0));
  });

  it("leaves short edges out", () => {
    expect(readTopology(mesh(CUBE), 1.5).edges.length).toBe(0);
  });
});

describe("rays", () => {
  it("meet what brute force meets", () => {
    let seed = 7;
    const random = (): number => ((seed = (seed * 16807) % 2147483647) / 2147483647) * 2 - 1;
    const positions = Float32Array.from({ length: 3 * 300 }, () => random() * 3);
    const indices = Uint32Array.from({ length: 300 }, (_, i) => i);
    const parts = [{ name: "", kind: "", first: 0, count: 300 }];
    const bvh = buildBvh([{ group: "structure", storey: 0, parts, positions, indices }]);
    let hits = 0;
    for (let ray = 0; ray < 200; ray++) {
      const o = [random() * 4, random() * 4, random() * 4];
      const raw = [random(), random(), random()];
      const d = raw.map((value) => value / Math.hypot(...raw));
      const expected = bruteForce(positions, o, d);
      const hit = bvh.cast(o[0], o[1], o[2], d[0], d[1], d[2]);
      if (expected === Infinity) expect(hit.distance).toBe(Infinity);
      else expect(hit.distance).toBeCloseTo(expected, 4);
      if (hit.distance < Infinity) {
        hits += 1;
        expect(hit.nx * d[0] + hit.ny * d[1] + hit.nz * d[2]).toBeLessThanOrEqual(0);
      }
    }
    expect(hits).toBeGreaterThan(50);
  });

  it("go through doors and glass", () => {
    const door = { ...mesh(CUBE), group: "door" as const };
    const glass = { ...mesh(CUBE), group: "glass" as const };
    expect(buildBvh([door, glass]).cast(0.5, 0.5, 5, 0, 0, -1).distance).toBe(Infinity);
    expect(buildBvh([mesh(CUBE), door]).cast(0.5, 0.5, 5, 0, 0, -1).distance).toBeCloseTo(4, 5);
  });
});

/** By solving o + t d = a + u (b − a) + v (c − a) with Cramer's rule. */
function bruteForce(p: Float32Array, o: number[], d: number[]): number {
  let least = Infinity;
  for (let i = 0; i < p.length; i += 9) {
    const a = Array.from(p.slice(i, i + 3));
    const e = Array.from(p.slice(i + 3, i + 6)).map((value, k) => value - a[k]);
    const f = Array.from(p.slice(i + 6, i + 9)).map((value, k) => value - a[k]);
    const s = o.map((value, k) => value - a[k]);
    const det3 = (x: number[], y: number[], z: number[]): number =>
      x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
    const minus = d.map((value) => -value);
    const det = det3(e, f, minus);
    if (Math.abs(det) < 1e-12) continue;
    const [u, v, t] = [det3(s, f, minus) / det, det3(e, s, minus) / det, det3(e, f, s) / det];
    if (u >= 0 && v >= 0 && u + v <= 1 && t >= 0) least = Math.min(least, t);
  }
  return least;
}
