// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Around the building: a target that is turned about, moved, and come nearer to. Room coordinates, y up. */

import { type Camera, Vector3 } from "three";
import type { Stage } from "../scene/stage";
import type { View } from "../scene/view";
import type { Covered } from "./covered";
import { extent } from "./extent";
import type { Viewpoint } from "./viewpoint";

const TURN_RAD_PER_PX = 0.006;
const LEAST_POLAR = 0.05;
const MOST_POLAR = 1.5;
const LEAST_M = 1.5;
/** Keypoints stay about this large in the picture: their radius over the distance. */
const PIN_PART = 0.0085;
const MARGIN = 1.05;
/** What is seen of a storey that is cut [m]. */
const CUT_M = 2;
/** The camera glides to where it is sent [1/s]. */
const GLIDE = 12;

export class Orbit implements Viewpoint {
  readonly name = "orbit";
  private readonly wanted = { target: new Vector3(), distance: 20, azimuth: -0.65, polar: 0.75 };
  private readonly now = { target: new Vector3(), distance: 20, azimuth: -0.65, polar: 0.75 };
  private fitted = false;

  constructor(
    private readonly view: View,
    private readonly stage: Stage,
    private readonly covered: () => Covered,
  ) {}

  get camera(): Camera {
    return this.view.camera;
  }

  enter(): void {
    this.stage.setMode("model");
    this.view.useFlatCamera(null);
    if (!this.fitted) this.fit();
  }

  leave(): void {
    this.view.camera.clearViewOffset();
  }

  fit(): void {
    const { store } = this.stage;
    const bounds = extent(store.state.building, store.state.keypoints, this.stage.bounds);
    this.fitted = this.stage.models !== null;
    const { building, selection } = store.state;
    const size = bounds.getSize(SIZE);
    const floorZ = building?.storeys[selection.storey]?.floorZ;
    const z = floorZ === undefined ? bounds.min.z + size.z / 2 : floorZ + 1;
    const { wanted } = this;
    wanted.target.set(bounds.min.x + size.x / 2, z, -(bounds.min.y + size.y / 2));
    const { clientWidth: width, clientHeight: height } = this.view.renderer.domElement;
    const { left, right, top, bottom } = this.covered();
    const free = { width: Math.max(60, width - left - right), height: Math.max(60, height - top - bottom) };
    const perPx = (2 * Math.tan(((this.view.camera.fov / 2) * Math.PI) / 180)) / height;
    const half = [size.x / 2, (floorZ === undefined ? size.z : CUT_M) / 2, size.y / 2] as const;
    AT.setFromSphericalCoords(1, wanted.polar, wanted.azimuth);
    wanted.distance = MARGIN * distanceFor(half, AT, (free.width / 2) * perPx, (free.height / 2) * perPx);
    this.jump();
  }

  /** Goes to a place of the map, keeping distance and angle. */
  lookAt(x: number, y: number, z: number): void {
    this.wanted.target.set(x, z, -y);
  }

  jump(): void {
    this.now.target.copy(this.wanted.target);
    Object.assign(this.now, { distance: this.wanted.distance, azimuth: this.wanted.azimuth, polar: this.wanted.polar });
  }

  drag(dx: number, dy: number, pan: boolean): void {
    const { wanted } = this;
    if (!pan) {
      wanted.azimuth -= dx * TURN_RAD_PER_PX;
      wanted.polar = Math.min(MOST_POLAR, Math.max(LEAST_POLAR, wanted.polar - dy * TURN_RAD_PER_PX));
      return;
    }
    const { camera, renderer } = this.view;
    const perPx = (2 * Math.tan((camera.fov * Math.PI) / 360) * wanted.distance) / renderer.domElement.clientHeight;
    const [sin, cos] = [Math.sin(wanted.azimuth), Math.cos(wanted.azimuth)];
    wanted.target.x -= (cos * dx + sin * dy) * perPx;
    wanted.target.z -= (-sin * dx + cos * dy) * perPx;
  }

  zoom(factor: number, clientX: number, clientY: number): void {
    const { wanted } = this;
    const { max, min } = this.stage.bounds;
    const most = 4 * Math.max(10, max.distanceTo(min));
    const distance = Math.min(most, Math.max(LEAST_M, wanted.distance * factor));
    const ray = this.view.pointerRay(clientX, clientY, RAY);
    // Towards what is under the pointer at the target's height, so that one zooms into a room by pointing at it.
    const along = (wanted.target.y - ray.origin.y) / ray.direction.y;
    if (along > 0 && along < most && factor < 1) {
      const share = 1 - distance / wanted.distance;
      wanted.target.lerp(AT.copy(ray.direction).multiplyScalar(along).add(ray.origin), share);
    }
    wanted.distance = distance;
  }

  frame(seconds: number): void {
    if (!this.fitted && this.stage.models) this.fit();
    const { now, wanted, view } = this;
    const share = 1 - Math.exp(-GLIDE * seconds);
    now.target.lerp(wanted.target, share);
    now.distance += (wanted.distance - now.distance) * share;
    now.azimuth += (wanted.azimuth - now.azimuth) * share;
    now.polar += (wanted.polar - now.polar) * share;
    view.rig.position.set(0, 0, 0);
    view.rig.quaternion.identity();
    const { camera } = view;
    camera.position.setFromSphericalCoords(now.distance, now.polar, now.azimuth).add(now.target);
    camera.lookAt(now.target);
    this.shift();
    this.stage.modelPinM = PIN_PART * now.distance;
  }

  /** Centres the picture in what the panel leaves free. */
  private shift(): void {
    const { clientWidth: width, clientHeight: height } = this.view.renderer.domElement;
    const { left, right, top, bottom } = this.covered();
    this.view.camera.setViewOffset(width, height, (right - left) / 2, (bottom - top) / 2, width, height);
  }
}

/**
 * How far a camera has to be from the middle of a box for all of it to be seen.
 *
 * @param half the box's half sides in the room.
 * @param back from the middle to the camera, of length 1.
 * @param tanX tangent of half the angle that is free for it sideways; `tanY` upright.
 */
export function distanceFor(half: readonly [number, number, number], back: Vector3, tanX: number, tanY: number): number {
  const right = new Vector3(0, 1, 0).cross(back).normalize();
  const up = back.clone().cross(right);
  let distance = 0;
  for (let corner = 0; corner < 8; corner++) {
    const at = new Vector3(...half.map((side, axis) => (corner & (1 << axis) ? side : -side)));
    const needed = Math.max(Math.abs(at.dot(right)) / tanX, Math.abs(at.dot(up)) / tanY);
    distance = Math.max(distance, at.dot(back) + needed);
  }
  return distance;
}

const SIZE = new Vector3();
const AT = new Vector3();
const RAY = { origin: new Vector3(), direction: new Vector3() };
