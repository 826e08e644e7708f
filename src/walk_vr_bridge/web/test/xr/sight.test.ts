// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { Bvh } from "../../src/scene/bvh";
import { bringIntoSight, inSight } from "../../src/xr/sight";

/** A wall of the map at x = 1, y -5 to 5, z 0 to 3. */
const wall = new Bvh(new Float32Array([1, -5, 0, 1, 5, 0, 1, 5, 3, 1, -5, 0, 1, 5, 3, 1, -5, 3]));
const eye = new Vector3(0, 1.6, -2);
const at = (x: number): Vector3 => new Vector3(x, 1.6, -2);

describe("a place of the room", () => {
  it("is in sight unless a wall is before it, or as near behind it as is asked", () => {
    expect([at(0.95), at(1.05), at(-3)].map((place) => inSight(wall, eye, place))).toEqual([true, false, true]);
    expect([at(0.85), at(0.95)].map((place) => inSight(wall, eye, place, 0.1))).toEqual([true, false]);
  });

  it("comes a hand's breadth before the wall that hides it, and not into the face", () => {
    expect(bringIntoSight(wall, eye, at(2)).x).toBeCloseTo(0.9);
    expect(bringIntoSight(wall, eye, at(0.97)).x).toBeCloseTo(0.9);
    expect(bringIntoSight(wall, eye, at(0.5)).x).toBe(0.5);
    expect(bringIntoSight(wall, eye, at(-2)).x).toBe(-2);
    const near = bringIntoSight(wall, at(0.8), new Vector3(2, 1.1, -2.4));
    expect(near.distanceTo(at(0.8))).toBeCloseTo(0.3);
  });

  it("stays where it is while there is no building", () => {
    expect(inSight(undefined, eye, at(9), 1)).toBe(true);
    expect(bringIntoSight(undefined, eye, at(9)).x).toBe(9);
  });
});
