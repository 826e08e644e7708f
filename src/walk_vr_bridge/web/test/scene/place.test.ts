// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { Group, Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { Keypoint } from "../../src/client/state";
import { makeWorld } from "../../src/scene/axes";
import { makeRay, Place } from "../../src/scene/place";

const keypoint = (id: number, x: number, y: number, z: number): Keypoint => ({
  id,
  position: [x, y, z],
  quat: [0, 0, 0, 1],
  label: "",
  locked: false,
  start: false,
  end: false,
  dwellS: null,
  lookAt: null,
  unreachable: "",
  pending: false,
});
const never = (): boolean => false;

function place(scale = 1): Place {
  const world = makeWorld();
  const group = new Group();
  group.scale.setScalar(scale);
  world.add(group);
  world.updateMatrixWorld(true);
  return new Place("miniature", group, 0.6);
}

describe("a place", () => {
  it("turns the map's axes into the room's: x, z, −y", () => {
    expect(place().toRoom(new Vector3(1, 2, 3), new Vector3()).distanceTo(new Vector3(1, 3, -2))).toBeLessThan(1e-9);
    expect(place(0.1).toMap(new Vector3(0.1, 0.3, -0.2), new Vector3()).distanceTo(new Vector3(1, 2, 3))).toBeLessThan(1e-9);
  });

  it("finds the nearest keypoint within reach, measured in the room", () => {
    const small = place(0.05);
    const points = [keypoint(1, 0, 0, 1.6), keypoint(2, 1, 0, 1.6)];
    // Drawn 0.6 m under the eye: at z = 1.
    const room = small.toRoom(new Vector3(0.9, 0, 1), new Vector3());
    expect(small.near(room, 0.06, points, never)).toBe(2);
    expect(small.near(room, 0.004, points, never)).toBe(null);
    expect(small.near(room, 0.06, points, ({ id }) => id === 2)).toBe(1);
  });

  it("finds what a ray points at best, and how far it is", () => {
    const full = place();
    const ray = makeRay();
    ray.origin.set(0, 1, 0);
    ray.direction.set(1, 0, 0);
    full.rayToMap(ray);
    const points = [keypoint(1, 4, 0.1, 1.6), keypoint(2, 8, 0.05, 1.6), keypoint(3, -4, 0, 1.6)];
    expect(full.pointedAt(points, 0.12, 0.035, 20, never)).toBe(2);
    expect(full.rayDistance).toBeCloseTo(8, 6);
    expect(full.pointedAt(points, 0.12, 0.035, 6, never)).toBe(1);
  });

  it("knows where a hand points in the map", () => {
    // Without a turn controllers look along the room's −z, which is the map's +y.
    expect(place().heading(new Quaternion())).toBeCloseTo(Math.PI / 2, 9);
  });
});
