// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { type Box3, BoxGeometry, Group, Matrix4, Mesh, MeshBasicMaterial, Plane, Quaternion, Vector3 } from "three";
import { Clip } from "./clipping";
import { BuildingCopy } from "./copy";

/** Longest side of the miniature when it is put up [m]. */
export const MINIATURE_M = 0.6;
const LEAST_M = 0.12;
const MOST_M = 4;

/** The building as a model in one's hands: carried, turned, scaled and cut. Its group speaks the map's coordinates. */
export class Miniature {
  readonly group = new Group();
  readonly clip = new Clip();
  readonly copy: BuildingCopy;
  /** The cut in world coordinates, as materials want it; all of the miniature's materials share it. */
  readonly planes: Plane[] = [new Plane()];
  /** The same for the path: on a ramp it rises above a cut that leaves the floor under it. */
  readonly pathPlanes: Plane[] = [new Plane()];
  private readonly base: Mesh<BoxGeometry, MeshBasicMaterial>;
  private readonly centre = new Vector3();
  private longest = 1;

  constructor(private readonly world: Group) {
    this.copy = new BuildingCopy(this.planes);
    this.base = new Mesh(new BoxGeometry(1, 1, 1), new MeshBasicMaterial({ color: "#66737e" }));
    this.group.name = "miniature";
    this.group.add(this.copy.group, this.base);
    world.add(this.group);
  }

  /** Takes the building's measures [m]: sets the plate under it and puts it up at its first size. */
  fit(bounds: Box3): void {
    const size = bounds.getSize(new Vector3());
    this.longest = Math.max(size.x, size.y, size.z, 0.1);
    bounds.getCenter(this.centre);
    this.centre.z = bounds.min.z;
    const thick = 0.012 * this.longest;
    this.base.scale.set(size.x + 0.06 * this.longest, size.y + 0.06 * this.longest, thick);
    this.base.position.set(this.centre.x, this.centre.y, bounds.min.z - thick / 2 - 0.002 * this.longest);
  }

  get scale(): number {
    return this.group.scale.x;
  }

  /** The scale within what hands can use. */
  clampScale(scale: number): number {
    return Math.min(MOST_M / this.longest, Math.max(LEAST_M / this.longest, scale));
  }

  /** Puts the middle of its ground at a place of the room, turned about the upright. */
  placeAt(room: Vector3, heading: number, scale = MINIATURE_M / this.longest): void {
    this.group.scale.setScalar(scale);
    this.group.quaternion.setFromAxisAngle(UP, heading);
    this.world.worldToLocal(AT.copy(room));
    SHIFT.copy(this.centre).multiplyScalar(scale).applyQuaternion(this.group.quaternion);
    this.group.position.copy(AT).sub(SHIFT);
    this.group.updateMatrixWorld(true);
  }

  /** Shows it at full size where the building stands: for the desktop's views. */
  placeTrue(): void {
    this.group.position.set(0, 0, 0);
    this.group.quaternion.identity();
    this.group.scale.setScalar(1);
    this.group.updateMatrixWorld(true);
  }

  /** Moves it to a pose of the room, given as matrix of map to world. */
  setWorldMatrix(matrix: Matrix4): void {
    TO_WORLD.copy(this.world.matrixWorld).invert().multiply(matrix);
    TO_WORLD.decompose(this.group.position, TURN, SCALE);
    this.group.quaternion.copy(TURN);
    this.group.scale.setScalar(SCALE.x);
    this.group.updateMatrixWorld(true);
  }

  showBase(visible: boolean): void {
    this.base.visible = visible;
  }

  /** Once a frame: brings the cut to where the miniature is now, for a path that is drawn so high over the floor [m]. */
  update(pathOverFloorM: number): void {
    this.group.updateMatrixWorld();
    this.planes[0].copy(this.clip.plane).applyMatrix4(this.group.matrixWorld).normalize();
    this.clip.writeRaised(pathOverFloorM, this.pathPlanes[0]);
    this.pathPlanes[0].applyMatrix4(this.group.matrixWorld).normalize();
  }
}

const UP = new Vector3(0, 0, 1);
const AT = new Vector3();
const SHIFT = new Vector3();
const SCALE = new Vector3();
const TURN = new Quaternion();
const TO_WORLD = new Matrix4();
