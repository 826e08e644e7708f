// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { Box3, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { BuildingState, Keypoint } from "../../src/client/state";
import { extent } from "../../src/desktop/extent";

const site = new Box3(new Vector3(-50, -50, -1), new Vector3(50, 50, 9));
const house = (...floors: number[][]): BuildingState =>
  ({ storeys: floors.map((floor) => ({ name: "", floorZ: 0, floor: Float32Array.from(floor) })) }) as unknown as BuildingState;

describe("the extent that a view is fitted to", () => {
  it("holds a long corridor's ends and every storey, not the site", () => {
    const box = extent(house([0, 0, 40, 1, 0], [5, -3, 6, 8, 3]), [], site);
    expect(box.min.toArray()).toEqual([-0.6, -3.6, -0.6]);
    expect(box.max.x).toBeCloseTo(40.6, 5);
    expect(box.max.y).toBeCloseTo(8.6, 5);
  });

  it("holds keypoints that stand elsewhere, and never more than the model", () => {
    const away = { position: [70, 2, 1.6] } as unknown as Keypoint;
    expect(extent(house([0, 0, 4, 4, 0]), [away], site).max.x).toBe(50);
  });

  it("is the model's where nobody walks", () => {
    expect(extent(null, [], site).equals(site)).toBe(true);
  });
});
