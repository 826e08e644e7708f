// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { Matrix4, Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { Button } from "../../src/xr/button";
import { Carry, upright } from "../../src/xr/carry";

const UPRIGHT = new Matrix4().makeRotationX(-Math.PI / 2);
const at = (x: number, y: number, z: number): Matrix4 => new Matrix4().makeTranslation(x, y, z).multiply(UPRIGHT);

describe("carrying", () => {
  it("moves with one fist, and turns with it about the upright", () => {
    const carry = new Carry();
    const thing = at(1, 1, 0);
    carry.beginOne(thing, new Matrix4());
    const moved = carry.one(new Matrix4().makeTranslation(0, 0.5, 2), new Matrix4());
    expect(new Vector3().setFromMatrixPosition(moved).toArray()).toEqual([1, 1.5, 2]);
    const turned = carry.one(new Matrix4().makeRotationY(Math.PI / 2), new Matrix4());
    expect(new Vector3().setFromMatrixPosition(turned).distanceTo(new Vector3(0, 1, -1))).toBeLessThan(1e-9);
  });

  it("is never tipped over, however the fist is tilted", () => {
    const carry = new Carry();
    carry.beginOne(at(0, 1, -0.3), new Matrix4());
    const tilt = new Quaternion(0.3, 0.2, -0.4, 0.84).normalize();
    const tilted = carry.one(new Matrix4().makeRotationFromQuaternion(tilt), new Matrix4());
    const up = new Vector3(0, 0, 1).transformDirection(tilted);
    expect(up.y).toBeCloseTo(1, 9);
  });

  it("scales and turns about the middle of two fists", () => {
    const carry = new Carry();
    const thing = at(0, 1, 0);
    carry.beginTwo(thing, new Vector3(-0.1, 1, 0), new Vector3(0.1, 1, 0));
    const out = carry.both(new Vector3(0, 1, 0.2), new Vector3(0, 1, -0.2), (factor) => factor, new Matrix4());
    expect(out.getMaxScaleOnAxis()).toBeCloseTo(2, 9);
    expect(new Vector3().setFromMatrixPosition(out).distanceTo(new Vector3(0, 1, 0))).toBeLessThan(1e-9);
    // What pointed to the right fist points to it still.
    const right = new Vector3(1, 0, 0).transformDirection(out);
    expect(right.distanceTo(new Vector3(0, 0, -1))).toBeLessThan(1e-9);
  });

  it("keeps the scale within limits", () => {
    const carry = new Carry();
    carry.beginTwo(at(0, 1, 0), new Vector3(-0.1, 1, 0), new Vector3(0.1, 1, 0));
    const out = carry.both(new Vector3(-1, 1, 0), new Vector3(1, 1, 0), (factor) => Math.min(3, factor), new Matrix4());
    expect(out.getMaxScaleOnAxis()).toBeCloseTo(3, 9);
  });

  it("leaves an upright pose as it is", () => {
    const pose = at(1, 2, 3).multiply(new Matrix4().makeRotationZ(0.7)).scale(new Vector3(0.1, 0.1, 0.1));
    const same = upright(pose.clone());
    same.elements.forEach((value, i) => expect(value).toBeCloseTo(pose.elements[i], 9));
  });
});

describe("a button", () => {
  it("tells its edges once, and does not flutter", () => {
    const button = new Button();
    const told = [0, 0.5, 0.7, 0.5, 0.4, 0.3, 0].map((value) => {
      button.update(value);
      return [button.down, button.pressed, button.released];
    });
    expect(told.map(([down]) => down)).toEqual([false, false, true, true, true, false, false]);
    expect(told.filter(([, pressed]) => pressed).length).toBe(1);
    expect(told.filter(([, , released]) => released).length).toBe(1);
  });
});
