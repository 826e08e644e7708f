// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { FAR_M, PathMeasurer, type Caster } from "../../src/client/measure";
import { readPath } from "../../src/client/path";
import { initialState, Store } from "../../src/client/store";
import { pathBytes } from "./path_bytes";

/** A corridor along x with its floor at 0.2 m and walls at y = low and y = high. */
function corridor(low: number, high: number): Caster {
  return {
    cast(_x, y, z, _dx, dy, dz, _least = 0, most = Infinity) {
      const wall = dy > 1e-9 ? (high - y) / dy : dy < -1e-9 ? (low - y) / dy : Infinity;
      const distance = Math.min(wall, dz < 0 ? (z - 0.2) / -dz : Infinity);
      return { distance: distance <= most ? distance : Infinity };
    },
  };
}

function measured(caster: Caster | readonly Caster[], colour: "clearance" | "plain" = "clearance", turns = 1000) {
  const store = new Store(initialState("me"));
  readPath(pathBytes([0, 1, 2].map((t) => ({ t, p: [t, 0.1 * t, 1.8] }))), store.state.path);
  store.patch("settings", { pathColour: colour });
  store.set("building", { walker: { eyeHeightM: 1.6, heightM: 1.8, radiusM: 0.25 } } as never);
  let ms = 0;
  const measurer = new PathMeasurer(
    store,
    () => [caster].flat(),
    () => ms++,
  );
  for (let turn = 0; turn < turns; turn++) measurer.step(2);
  return store;
}

describe("what is measured along the path", () => {
  it("is the height over the floor and the nearer wall less the body's radius", () => {
    const { path } = measured(corridor(-0.5, 0.7)).state;
    for (const [row, least] of [0.5, 0.6, 0.5].entries()) {
      expect(path.heightM[row]).toBeCloseTo(1.6, 5);
      expect(path.clearanceM[row]).toBeCloseTo(least - 0.25, 5);
    }
  });

  it("is below 0 where the body touches, and stops where it is far", () => {
    expect(measured(corridor(-0.1, 5)).state.path.clearanceM[0]).toBeLessThan(0);
    expect(measured(corridor(-9, 9)).state.path.clearanceM[0]).toBeCloseTo(FAR_M, 5);
  });

  it("is of whatever is nearest: a pane before a wall", () => {
    const pane = corridor(-0.45, 9);
    expect(measured([corridor(-0.5, 0.7), pane]).state.path.clearanceM[0]).toBeCloseTo(0.45 - 0.25, 5);
  });

  it("is that of a body that hangs from the eye, beside a ramp that it has just left", () => {
    // The floor right below is 0.25 m under where the eye comes from: a body on it would stand in the ramp's side.
    const side: Caster = {
      cast(_x, y, z, _dx, dy, dz, _least = 0, most = Infinity) {
        const wall = dy < -1e-9 && z < 0.44 ? y / -dy : Infinity;
        const distance = Math.min(wall, dz < 0 ? z / -dz : Infinity);
        return { distance: distance <= most ? distance : Infinity };
      },
    };
    const { path } = measured(side).state;
    expect(path.heightM[0]).toBeCloseTo(1.8, 5);
    expect(path.clearanceM[0]).toBeCloseTo(FAR_M, 5);
  });

  it("is told once, and not measured where nobody looks at it", () => {
    expect(measured(corridor(-1, 1)).version("path")).toBe(1);
    expect(measured(corridor(-1, 1), "plain").state.path.clearanceM[0]).toBeNaN();
  });
});
