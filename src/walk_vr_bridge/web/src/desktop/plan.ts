// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A storey from above, without perspective, cut over its tables: the plan an architect draws. */

import { OrthographicCamera } from "three";
import type { Stage } from "../scene/stage";
import type { View } from "../scene/view";
import type { Covered } from "./covered";
import { extent } from "./extent";
import type { Viewpoint } from "./viewpoint";

const MARGIN = 1.06;
const LEAST_M = 2;
/** Radius of a keypoint over the height of what is shown. */
const PIN_PART = 0.0115;
const HIGH_M = 300;

export class Plan implements Viewpoint {
  readonly name = "plan";
  readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0.1, 2 * HIGH_M);
  private centreX = 0;
  private centreY = 0;
  /** Height of the map that the picture shows [m]. */
  private heightM = 20;
  private fittedTo = "";

  constructor(
    private readonly view: View,
    private readonly stage: Stage,
    private readonly covered: () => Covered,
  ) {}

  enter(): void {
    this.stage.setMode("model");
    const { store } = this.stage;
    // A plan is of one storey: of the one a visitor begins on, unless another is chosen.
    if (store.state.selection.storey < 0 && store.state.building) {
      store.patch("selection", { storey: this.stage.storeyAt(store.state.building.start[2]) });
    }
    this.view.useFlatCamera(this.camera);
    if (this.fittedTo !== store.state.building?.hash) this.fit();
  }

  leave(): void {
    this.view.useFlatCamera(null);
  }

  fit(): void {
    const { store, models } = this.stage;
    const bounds = extent(store.state.building, store.state.keypoints, this.stage.bounds);
    this.fittedTo = (models && store.state.building?.hash) || "";
    const { clientWidth: width, clientHeight: height } = this.view.renderer.domElement;
    const { left, right, top, bottom } = this.covered();
    const [wide, tall] = [bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y];
    const free = { width: Math.max(50, width - left - right), height: Math.max(50, height - top - bottom) };
    this.heightM = MARGIN * height * Math.max(wide / free.width, tall / free.height);
    const perPx = this.heightM / height;
    this.centreX = (bounds.min.x + bounds.max.x) / 2 + ((right - left) / 2) * perPx;
    this.centreY = (bounds.min.y + bounds.max.y) / 2 - ((bottom - top) / 2) * perPx;
  }

  drag(dx: number, dy: number): void {
    const perPx = this.heightM / this.view.renderer.domElement.clientHeight;
    this.centreX -= dx * perPx;
    this.centreY += dy * perPx;
  }

  zoom(factor: number, clientX: number, clientY: number): void {
    const { clientWidth: width, clientHeight: height } = this.view.renderer.domElement;
    const next = Math.min(2000, Math.max(LEAST_M, this.heightM * factor));
    const perPx = (this.heightM - next) / height;
    this.centreX += (clientX - width / 2) * perPx;
    this.centreY -= (clientY - height / 2) * perPx;
    this.heightM = next;
  }

  frame(): void {
    if (!this.fittedTo && this.stage.models) this.fit();
    const { clientWidth: width, clientHeight: height } = this.view.renderer.domElement;
    const half = this.heightM / 2;
    const wide = (half * width) / Math.max(1, height);
    Object.assign(this.camera, { left: -wide, right: wide, top: half, bottom: -half });
    this.camera.position.set(this.centreX, HIGH_M, -this.centreY);
    this.camera.quaternion.set(-Math.SQRT1_2, 0, 0, Math.SQRT1_2);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    // Notes and numbers turn to the usual camera: it looks the same way.
    this.view.rig.position.set(0, 0, 0);
    this.view.rig.quaternion.identity();
    this.view.camera.position.copy(this.camera.position);
    this.view.camera.quaternion.copy(this.camera.quaternion);
    this.stage.modelPinM = PIN_PART * this.heightM;
  }
}
