// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Inside the building at full scale: walking with keys and mouse, or along the tour while it plays. */

import { type Camera, Vector3 } from "three";
import { samplePath, pathPoint, playbackTimeS } from "../client/playback";
import { headingOf } from "../scene/axes";
import type { Stage } from "../scene/stage";
import type { View } from "../scene/view";
import type { Viewpoint } from "./viewpoint";

const LOOK_RAD_PER_PX = 0.0035;
const MOST_PITCH = 1.3;
const WALK_MPS = 1.8;
const RUN = 2;
/** Steps up to this are climbed, and the floor is looked for this far down [m]. */
const STEP_M = 0.45;
const DROP_M = 1.2;
/** How near to a wall one comes [m]. */
const BODY_M = 0.25;
/** How fast the look comes back ahead along the tour [1/s]. */
const FOLLOW = 5;

export class Stroll implements Viewpoint {
  readonly name = "walk";
  /** Keys that are held: forward, back, left, right, and fast. */
  readonly keys = { forward: 0, back: 0, left: 0, right: 0, fast: 0 };
  /** Whether one is carried along the tour while it plays; a step of one's own leaves it. */
  along = false;
  private readonly position = new Vector3();
  private heading = 0;
  private pitch = 0;
  private placed = "";
  private readonly point = pathPoint();
  /** How far one has looked aside while riding. */
  private aside = 0;

  constructor(
    private readonly view: View,
    private readonly stage: Stage,
  ) {}

  get camera(): Camera {
    return this.view.camera;
  }

  enter(): void {
    this.view.useFlatCamera(null);
    this.stage.setMode("inside");
    if (this.placed !== this.stage.store.state.building?.hash) this.fit();
  }

  leave(): void {
    this.stage.riding = false;
  }

  /** Goes to where a visitor begins. */
  fit(): void {
    const { building, keypoints } = this.stage.store.state;
    if (!building) return;
    this.placed = building.hash;
    const [x, y, z] = building.start;
    this.position.set(x, y, z + building.walker.eyeHeightM);
    const first = keypoints[0];
    if (first) this.heading = Math.atan2(first.position[1] - y, first.position[0] - x);
  }

  /** Stands at a place of the map and looks along a heading. */
  stand(x: number, y: number, eyeZ: number, heading: number): void {
    this.placed = this.stage.store.state.building?.hash ?? "";
    this.position.set(x, y, eyeZ);
    this.heading = heading;
    this.pitch = 0;
  }

  drag(dx: number, dy: number): void {
    if (this.riding) this.aside += dx * LOOK_RAD_PER_PX;
    else this.heading += dx * LOOK_RAD_PER_PX;
    this.pitch = Math.min(MOST_PITCH, Math.max(-MOST_PITCH, this.pitch + dy * LOOK_RAD_PER_PX));
  }

  /** The wheel steps ahead or back. */
  zoom(factor: number): void {
    this.along = false;
    this.step(factor < 1 ? 0.4 : -0.4, 0);
  }

  get riding(): boolean {
    return this.along && this.stage.store.state.playback.playing;
  }

  frame(seconds: number): void {
    if (!this.placed) this.fit();
    const { forward, back, left, right } = this.keys;
    if (forward || back || left || right) this.along = false;
    this.stage.riding = this.riding;
    if (this.riding) this.ride(seconds);
    else this.stroll(seconds);
    const { rig, camera } = this.view;
    const look = this.heading + (this.riding ? this.aside : 0);
    rig.quaternion.identity();
    // The rig is where the walker's feet are: keypoints on lower floors are dimmed by it.
    rig.position.set(this.position.x, this.position.z - this.stage.eyeHeightM, -this.position.y);
    camera.position.set(0, this.stage.eyeHeightM, 0);
    camera.rotation.set(this.pitch, look - Math.PI / 2, 0, "YXZ");
  }

  private ride(seconds: number): void {
    const { path, playback } = this.stage.store.state;
    if (!samplePath(path, playbackTimeS(playback, Date.now()), this.point)) return;
    const { position, quat } = this.point;
    this.position.set(position[0]!, position[1]!, position[2]!);
    this.heading = headingOf(quat[0]!, quat[1]!, quat[2]!, quat[3]!);
    const back = Math.exp(-FOLLOW * seconds * 0.1);
    this.aside *= back;
    this.pitch *= back;
  }

  private stroll(seconds: number): void {
    const { forward, back, left, right, fast } = this.keys;
    const speed = WALK_MPS * (fast ? RUN : 1) * seconds;
    const [ahead, side] = [forward - back, right - left];
    if (ahead || side) this.step((ahead * speed) / Math.hypot(ahead, side), (side * speed) / Math.hypot(ahead, side));
  }

  /** Steps ahead and aside [m], on the floor, not through walls. */
  private step(ahead: number, side: number): void {
    const [cos, sin] = [Math.cos(this.heading), Math.sin(this.heading)];
    const dx = cos * ahead + sin * side;
    const dy = sin * ahead - cos * side;
    if (!this.go(dx, dy) && !this.go(dx, 0)) this.go(0, dy);
  }

  private go(dx: number, dy: number): boolean {
    const bvh = this.stage.models?.bvh;
    const length = Math.hypot(dx, dy);
    if (!bvh || length < 1e-6) return false;
    const { x, y, z } = this.position;
    const eye = this.stage.eyeHeightM;
    for (const height of [0, 0.45 * eye]) {
      const wall = bvh.cast(x, y, z - height, dx / length, dy / length, 0, 0, length + BODY_M);
      if (wall.distance < length + BODY_M) return false;
    }
    const from = z - eye + STEP_M;
    const floor = bvh.cast(x + dx, y + dy, from, 0, 0, -1, 0, STEP_M + DROP_M);
    if (!Number.isFinite(floor.distance)) return false;
    this.position.set(x + dx, y + dy, from - floor.distance + eye);
    return true;
  }
}
