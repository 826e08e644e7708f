// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from "three";
import { expect, it } from "vitest";
import { fillsView } from "../../src/scene/walker";

it("is too near to be seen as a figure where the eye is in it or right beside, not on another floor", () => {
  const figure = new Float32Array([6, 2, 1.6]);
  // The map's x, y, z are x, -z, y of the room.
  expect(fillsView(figure, new Vector3(6, 1.6, -2))).toBe(true);
  expect(fillsView(figure, new Vector3(6.5, 1.2, -2.5))).toBe(true);
  expect(fillsView(figure, new Vector3(6.6, 1.6, -2.6))).toBe(false);
  expect(fillsView(figure, new Vector3(6, 1.6, 2))).toBe(false);
  expect(fillsView(figure, new Vector3(6, 4.4, -2))).toBe(false);
});
