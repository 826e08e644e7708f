// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** The maths of carrying: one fist moves and turns a thing, two fists also scale it. All in the room's coordinates. */

import { Matrix4, Quaternion, Vector3 } from "three";

export class Carry {
  private readonly offset = new Matrix4();
  private readonly start = new Matrix4();
  private readonly middle = new Vector3();
  private readonly span = new Vector3();
  private two = false;

  /** One fist takes hold of the thing. */
  beginOne(thing: Matrix4, grip: Matrix4): void {
    this.two = false;
    this.offset.copy(grip).invert().multiply(thing);
  }

  /** Both fists hold it. */
  beginTwo(thing: Matrix4, a: Vector3, b: Vector3): void {
    this.two = true;
    this.start.copy(thing);
    this.middle.addVectors(a, b).multiplyScalar(0.5);
    this.span.subVectors(b, a);
  }

  /** Where one fist has brought it. A model is never tipped over: only its turn about the upright follows. */
  one(grip: Matrix4, out: Matrix4): Matrix4 {
    return upright(out.multiplyMatrices(grip, this.offset));
  }

  /**
   * Where both fists have brought it: moved with their middle, turned about the upright with the line between them, scaled
   * with their distance, the scale kept within what `clamp` says.
   */
  both(a: Vector3, b: Vector3, clamp: (factor: number) => number, out: Matrix4): Matrix4 {
    if (!this.two) return out;
    SPAN.subVectors(b, a);
    const factor = clamp(SPAN.length() / Math.max(1e-3, this.span.length()));
    const turn = Math.atan2(-SPAN.z, SPAN.x) - Math.atan2(-this.span.z, this.span.x);
    MIDDLE.addVectors(a, b).multiplyScalar(0.5);
    out.makeTranslation(MIDDLE.x, MIDDLE.y, MIDDLE.z);
    out.multiply(PART.makeRotationY(turn));
    out.multiply(PART.makeScale(factor, factor, factor));
    out.multiply(PART.makeTranslation(-this.middle.x, -this.middle.y, -this.middle.z));
    return out.multiply(this.start);
  }
}

/** Takes the tilt out of the pose of something whose own upright is its z axis. */
export function upright(pose: Matrix4): Matrix4 {
  pose.decompose(MIDDLE, TURN, SPAN);
  UP.set(0, 0, 1).applyQuaternion(TURN);
  TILT.setFromUnitVectors(UP, ROOM_UP);
  TURN.premultiply(TILT);
  return pose.compose(MIDDLE, TURN, SPAN);
}

const ROOM_UP = new Vector3(0, 1, 0);
const UP = new Vector3();
const SPAN = new Vector3();
const MIDDLE = new Vector3();
const TURN = new Quaternion();
const TILT = new Quaternion();
const PART = new Matrix4();
