// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { emptyPath } from "../../src/client/store";
import type { BuildingMesh } from "../../src/scene/glb";
import { buildBvh } from "../../src/scene/model";
import { Profile } from "../../src/scene/profile";
import { PathTube } from "../../src/scene/tube";

/** Two walls 2 m apart, at y = 0 and y = 2, and the floor between them at z = 0. */
function corridor(): BuildingMesh {
  const quads = [
    [[-50, 0, 0], [50, 0, 0], [50, 0, 3], [-50, 0, 3]],
    [[-50, 2, 0], [50, 2, 0], [50, 2, 3], [-50, 2, 3]],
    [[-50, 0, 0], [50, 0, 0], [50, 2, 0], [-50, 2, 0]],
  ];
  const indices = Uint32Array.from(quads.flatMap((_, q) => [0, 1, 2, 0, 2, 3].map((corner) => 4 * q + corner)));
  const parts = [{ name: "", kind: "", first: 0, count: indices.length }];
  return { group: "structure", storey: 0, parts, positions: Float32Array.from(quads.flat(2)), indices };
}

describe("the profile of a path", () => {
  it("has the distance to the walls less the body's radius, and the height over the floor", () => {
    const path = emptyPath();
    const count = 100;
    path.count = count;
    path.revision = "1";
    // From the middle of the corridor to a hand's breadth from its wall, which the body does not fit in.
    path.positions = Float32Array.from({ length: 3 * count }, (_, i) => [i / 30, 1 + (0.9 * Math.floor(i / 3)) / (count - 1), 1.6][i % 3]);
    path.clearanceM = new Float32Array(count).fill(NaN);
    path.heightM = new Float32Array(count).fill(NaN);
    const tube = new PathTube();
    tube.setPath(path.positions, count);
    const profile = new Profile();
    const bvh = buildBvh([corridor()]);
    let steps = 0;
    while (profile.step(path, tube, bvh, 0.25)) steps += 1;
    expect(steps).toBeGreaterThan(3);
    expect(path.clearanceM[0]).toBeCloseTo(1 - 0.25, 4);
    expect(path.clearanceM[count - 1]).toBeCloseTo(0.1 - 0.25, 4);
    for (let row = 0; row < count; row++) expect(path.heightM[row]).toBeCloseTo(1.6, 4);
  });

  it("leaves alone what the bridge has said", () => {
    const path = emptyPath();
    path.count = 2;
    path.revision = "1";
    path.positions = Float32Array.from([0, 1, 1.6, 1, 1, 1.6]);
    path.clearanceM = Float32Array.from([0.3, 0.4]);
    path.heightM = Float32Array.from([1.5, 1.5]);
    const tube = new PathTube();
    tube.setPath(path.positions, 2);
    expect(new Profile().step(path, tube, buildBvh([corridor()]), 0.25)).toBe(false);
    expect(Array.from(path.clearanceM)).toEqual([Math.fround(0.3), Math.fround(0.4)]);
  });
});
