// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { CylinderGeometry, Group, Mesh, MeshLambertMaterial, TorusGeometry, DoubleSide, type Vector3 } from "three";

/** What is dropped within this distance of the bin's mouth is thrown away [m]. */
export const BIN_RADIUS_M = 0.08;

/** The red recycling bin: stands in the room, never in the map. Its origin is the middle of its mouth. */
export class Bin {
  readonly group = new Group();
  private readonly material = new MeshLambertMaterial({ color: "#d9363e", side: DoubleSide });
  private open = 0;

  constructor() {
    const pail = new Mesh(new CylinderGeometry(0.055, 0.042, 0.13, 20, 1, true), this.material);
    pail.position.y = -0.065;
    const rim = new Mesh(new TorusGeometry(0.055, 0.006, 6, 24).rotateX(Math.PI / 2), this.material);
    const floor = new Mesh(new CylinderGeometry(0.042, 0.042, 0.004, 20), this.material);
    floor.position.y = -0.128;
    this.group.add(pail, rim, floor);
    this.group.name = "bin";
  }

  /** Whether a place of the room is within reach of the mouth. */
  takes(room: Vector3): boolean {
    return this.group.visible && room.distanceTo(this.group.position) <= BIN_RADIUS_M;
  }

  /** Grows while something is held over it. */
  invite(over: boolean): void {
    this.open += ((over ? 1 : 0) - this.open) * 0.3;
    this.group.scale.setScalar(1 + 0.25 * this.open);
    this.material.emissive.setRGB(0.35 * this.open, 0, 0);
  }
}
