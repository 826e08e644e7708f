// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { type Group, Matrix4, Vector3 } from "three";
import type { Miniature } from "../scene/miniature";
import type { View } from "../scene/view";

/** Moves what the user stands on: always the rig, never the head. What the user has at hand comes along. */
export class Rig {
  readonly group: Group;
  private readonly before = new Matrix4();
  private readonly carried = new Matrix4();

  constructor(
    private readonly view: View,
    private readonly miniature: Miniature,
    private readonly atHand: readonly { matrixAutoUpdate: boolean; position: Vector3; rotation: { y: number } }[] = [],
  ) {
    this.group = view.rig;
  }

  get heading(): number {
    return this.group.rotation.y;
  }

  /** Puts the floor under the user to a height, the head over x, z of the room; the head's own heading stays. */
  headTo(x: number, floorY: number, z: number): void {
    this.begin();
    const { group } = this;
    group.position.x += x - this.view.eye.x;
    group.position.z += z - this.view.eye.z;
    group.position.y = floorY;
    this.commit();
  }

  /** Moves by a step of the room. */
  move(dx: number, dy: number, dz: number): void {
    this.begin();
    this.group.position.x += dx;
    this.group.position.y += dy;
    this.group.position.z += dz;
    this.commit();
  }

  /** Turns about the head, left is positive [rad]. */
  turn(angle: number): void {
    this.begin();
    const { group } = this;
    const { eye } = this.view;
    AT.copy(group.position).sub(eye).applyAxisAngle(UP, angle);
    const height = group.position.y;
    group.position.copy(eye).add(AT);
    group.position.y = height;
    group.rotation.y += angle;
    this.commit();
  }

  private begin(): void {
    this.group.updateMatrixWorld();
    this.before.copy(this.group.matrixWorld).invert();
  }

  private commit(): void {
    const { group, miniature } = this;
    const heading = group.rotation.y;
    group.updateMatrixWorld(true);
    this.carried.multiplyMatrices(group.matrixWorld, this.before);
    for (let i = 0; i < this.atHand.length; i++) this.atHand[i].position.applyMatrix4(this.carried);
    const turned = Math.atan2(this.carried.elements[8], this.carried.elements[0]);
    for (let i = 0; i < this.atHand.length; i++) this.atHand[i].rotation.y += turned;
    miniature.group.updateMatrixWorld();
    miniature.setWorldMatrix(this.carried.multiply(miniature.group.matrixWorld));
    group.rotation.y = heading;
    this.view.eye.setFromMatrixPosition(this.view.camera.matrixWorld);
  }
}

const UP = new Vector3(0, 1, 0);
const AT = new Vector3();
