// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { PerspectiveCamera, Scene, WebGLRenderer } from "three";

/** The renderer with the scene, the camera and the frame loop that desktop and headset share. */
export class View {
  readonly renderer: WebGLRenderer;
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(60, 1, 0.03, 400);

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.localClippingEnabled = true;
    this.renderer.xr.enabled = true;
  }

  start(): void {
    this.renderer.setAnimationLoop(() => this.renderer.render(this.scene, this.camera));
  }
}
