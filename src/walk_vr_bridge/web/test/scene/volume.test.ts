// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Channel, ImportanceState, Storey } from "../../src/client/state";
import { choosePoints, MAX_POINTS, rangeIndoors } from "../../src/scene/volume";

const NAMES = ["obstacle", "distance", "visibility", "importance"] as const;
const channels = NAMES.map((name) => ({ name, low: 0, high: 1 })) as unknown as [Channel, Channel, Channel, Channel];

/** Free voxels of 1 m whose importance is what the function says, 0 to 255; obstacles where it is below 0. */
function volume(shape: [number, number, number], importance: (x: number, y: number, z: number) => number): ImportanceState {
  const [nx, ny, nz] = shape;
  const data = new Uint8Array(4 * nx * ny * nz);
  for (let i = 0; i < nx * ny * nz; i++) {
    const value = importance(i % nx, Math.floor(i / nx) % ny, Math.floor(i / (nx * ny)));
    if (value < 0) data[4 * i] = 255;
    else data[4 * i + 3] = value;
  }
  return { origin: [0, 0, 0], voxelM: 1, shape, channels, data, revision: "1" };
}

describe("the points of a map", () => {
  it("are at most twenty thousand, the same each time, at the middles of free voxels", () => {
    const map = volume([60, 60, 40], (x) => (x < 30 ? -1 : 255));
    const points = choosePoints(map, "importance");
    const places = points.getAttribute("position");
    expect(places.count).toBeLessThanOrEqual(MAX_POINTS);
    expect(places.count).toBeGreaterThan(0.9 * MAX_POINTS);
    for (let i = 0; i < places.count; i++) {
      expect(places.getX(i)).toBeGreaterThan(30);
      expect(places.getX(i) % 1).toBe(0.5);
    }
    expect(choosePoints(map, "importance").getAttribute("position").array).toEqual(places.array);
  });

  it("are denser where the value is high", () => {
    const map = volume([40, 40, 40], (x) => (x < 20 ? 60 : 240));
    const places = choosePoints(map, "importance").getAttribute("position");
    let high = 0;
    for (let i = 0; i < places.count; i++) if (places.getX(i) > 20) high += 1;
    // The chance goes with the square of the value: 16 to 1.
    expect(high / (places.count - high)).toBeGreaterThan(10);
    expect(high / (places.count - high)).toBeLessThan(25);
  });

  it("are the occupied voxels in the map of obstacles", () => {
    const map = volume([6, 6, 6], (x, y, z) => (x === 2 && y === 3 && z === 4 ? -1 : 9));
    expect(Array.from(choosePoints(map, "obstacle").getAttribute("position").array)).toEqual([2.5, 3.5, 4.5]);
  });
});

describe("the range of the colours", () => {
  const around = [2, 2, 18, 8, 0, 2, 8, 8, 12, 0, 12, 8, 18, 12, 0, 2, 12, 18, 18, 0];
  const square: Storey = { name: "", floorZ: 0, floor: Float32Array.from(around) };

  it("is that of the walkable floors: neither outdoors nor holes count", () => {
    const map = volume([20, 20, 3], (x, y) => {
      const hole = x >= 8 && x < 12 && y >= 8 && y < 12;
      const outdoors = x < 2 || y < 2 || x >= 18 || y >= 18;
      return hole || outdoors ? 255 : 51 + (x - 2) * 6.8;
    });
    const [low, high] = rangeIndoors(map, "importance", [square]);
    expect(low).toBeCloseTo(51 / 255, 2);
    expect(high).toBeCloseTo((51 + 15 * 6.8) / 255, 2);
  });

  it("is read over each floor's own height, a voxel once", () => {
    const map = volume([20, 20, 8], (_x, _y, z) => (z === 1 ? 60 : z === 4 ? 180 : 255));
    const strips = Array.from({ length: 20 }, (_, k) => [k * 0.5, 0, k * 0.5 + 0.5, 2, 0]).flat();
    const raised: Storey = { name: "", floorZ: 0, floor: Float32Array.from([...strips, 10, 0, 20, 2, 3]) };
    const [low, high] = rangeIndoors(map, "importance", [raised]);
    expect([low, high]).toEqual([60 / 255, 180 / 255]);
  });

  it("is the whole one where there is no walkable floor", () => {
    expect(rangeIndoors(volume([4, 4, 4], () => 7), "importance", [])).toEqual([0, 1]);
  });
});
