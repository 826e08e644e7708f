// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { Box3, Group, Plane, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { makeWorld } from "../../src/scene/axes";
import { Clip, CUT_OVER_FLOOR_M } from "../../src/scene/clipping";
import { Miniature } from "../../src/scene/miniature";

const storeys = [0, 3, 6].map((floorZ) => ({ name: `${floorZ}`, floorZ, floor: new Float32Array() }));

function clip(): Clip {
  const made = new Clip();
  made.reset(-0.2, 9, storeys);
  return made;
}

describe("the cut", () => {
  it("takes nothing away at first and at the top", () => {
    const cut = clip();
    expect(cut.active).toBe(false);
    expect(cut.keeps(0, 0, 9)).toBe(true);
    cut.cutAt(4, true);
    cut.cutAt(20, true);
    expect(cut.active).toBe(false);
  });

  it("snaps to a storey that is near, and moves freely between them", () => {
    const cut = clip();
    cut.cutAt(3 + CUT_OVER_FLOOR_M + 0.2, true);
    expect(cut.storey).toBe(1);
    expect(cut.plane.constant).toBeCloseTo(3 + CUT_OVER_FLOOR_M, 9);
    cut.cutAt(3 + CUT_OVER_FLOOR_M + 1, true);
    expect(cut.storey).toBe(-1);
    expect(cut.plane.constant).toBeCloseTo(3 + CUT_OVER_FLOOR_M + 1, 9);
    cut.cutAt(3 + CUT_OVER_FLOOR_M + 0.2, false);
    expect(cut.storey).toBe(-1);
  });

  it("cuts the path where it cuts the floor under it, not where it is drawn", () => {
    const cut = clip();
    cut.cutStorey(0);
    const raised = new Plane();
    cut.writeRaised(1, raised);
    for (const floorZ of [0, 0.7, 1.2, 1.35, 3]) {
      const kept = raised.distanceToPoint(new Vector3(0, 0, floorZ + 1)) >= 0;
      expect(kept, `a floor at ${floorZ} m`).toBe(cut.keepsOnFloor(0, 0, floorZ));
    }
    cut.cutAlong(new Vector3(1, 0, 0), new Vector3(2, 0, 0));
    cut.writeRaised(1, raised);
    expect(raised.distanceToPoint(new Vector3(1, 0, 5))).toBeGreaterThan(0);
    expect(raised.distanceToPoint(new Vector3(3, 0, 5))).toBeLessThan(0);
  });

  it("keeps what is below it, and says which storey lies open", () => {
    const cut = clip();
    cut.cutStorey(1);
    expect(cut.openStorey).toBe(1);
    expect(cut.keeps(5, 5, 4.3)).toBe(true);
    expect(cut.keeps(5, 5, 4.5)).toBe(false);
    cut.cutAt(2.7, true);
    expect(cut.openStorey).toBe(0);
  });

  it("can be held askew through a point", () => {
    const cut = clip();
    const point = new Vector3(2, 1, 4);
    cut.cutAlong(new Vector3(1, 0, 1).normalize(), point);
    expect(cut.isLevel()).toBe(false);
    expect(cut.plane.distanceToPoint(point)).toBeCloseTo(0, 9);
    expect(cut.keeps(0, 1, 4)).toBe(true);
    expect(cut.keeps(4, 1, 4)).toBe(false);
    expect(cut.heightAt(2, 1)).toBeCloseTo(4, 9);
    expect(cut.heightAt(3, 1)).toBeCloseTo(3, 9);
  });
});

describe("the miniature", () => {
  function miniature(): { world: Group; made: Miniature } {
    const world = makeWorld();
    const made = new Miniature(world);
    made.fit(new Box3(new Vector3(0, 0, 0), new Vector3(12, 6, 9)));
    made.clip.reset(0, 9, storeys);
    return { world, made };
  }

  it("is 0.6 m long and stands upright where it is put", () => {
    const { made } = miniature();
    made.placeAt(new Vector3(1, 0.8, -2), 0.7);
    const middle = new Vector3(6, 3, 0).applyMatrix4(made.group.matrixWorld);
    expect(middle.distanceTo(new Vector3(1, 0.8, -2))).toBeLessThan(1e-9);
    const top = new Vector3(6, 3, 9).applyMatrix4(made.group.matrixWorld);
    expect(top.y - middle.y).toBeCloseTo((0.6 * 9) / 12, 9);
    expect(Math.hypot(top.x - middle.x, top.z - middle.z)).toBeLessThan(1e-9);
  });

  it("has its cut where the model's cut is, however it is carried", () => {
    const { made } = miniature();
    made.placeAt(new Vector3(-3, 1.1, 4), 2.1);
    made.clip.cutStorey(1);
    made.update(1);
    const onCut = new Vector3(7, 2, 3 + CUT_OVER_FLOOR_M).applyMatrix4(made.group.matrixWorld);
    const below = new Vector3(7, 2, 3).applyMatrix4(made.group.matrixWorld);
    expect(made.planes[0].distanceToPoint(onCut)).toBeCloseTo(0, 9);
    expect(made.planes[0].distanceToPoint(below)).toBeCloseTo((CUT_OVER_FLOOR_M * 0.6) / 12, 9);
  });

  it("does not become too small or too large to handle", () => {
    const { made } = miniature();
    expect(made.clampScale(1e-9) * 12).toBeCloseTo(0.12, 9);
    expect(made.clampScale(1e9) * 12).toBeCloseTo(4, 9);
  });
});
