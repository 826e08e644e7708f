// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Color, DirectionalLight, Group, HemisphereLight, type OrthographicCamera, PerspectiveCamera } from "three";
import { Scene, Vector3, WebGLRenderer } from "three";
import { useFastColours } from "./colourspace";
import { makeGround } from "./ground";
import { SKY_COLOUR } from "./palette";
import type { Ray } from "./place";

/** Called once a frame with the seconds since the last one; in a headset with its frame. */
export type FrameListener = (seconds: number, frame: XRFrame | null) => void;

/** Longer gaps, as of a page in the background, count as this long [s]. */
const LONGEST_FRAME_S = 0.1;

/** The renderer with its scene, cameras and the one loop that desktop and headset share. */
export class View {
  readonly renderer: WebGLRenderer;
  readonly scene = new Scene();
  /** What the user stands on: moving it moves the user. The camera hangs under it. */
  readonly rig = new Group();
  readonly camera = new PerspectiveCamera(60, 1, 0.03, 600);
  /** Where the viewer's head is, in the room. */
  readonly eye = new Vector3();
  readonly ground = makeGround();
  /** Frames drawn so far. */
  frames = 0;
  private flat: OrthographicCamera | null = null;
  private readonly listeners: FrameListener[] = [];
  private last = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    // Without a graphics card smooth edges take twice as long, and the page hears nothing while it draws.
    const antialias = !new URLSearchParams(window.location.search).has("plain");
    useFastColours();
    this.renderer = new WebGLRenderer({ canvas, antialias, powerPreference: "high-performance" });
    this.renderer.localClippingEnabled = true;
    this.renderer.xr.enabled = true;
    this.renderer.xr.setReferenceSpaceType("local-floor");
    this.renderer.setClearColor(SKY_COLOUR);
    this.renderer.info.autoReset = false;
    this.scene.background = new Color(SKY_COLOUR);
    this.rig.name = "rig";
    this.rig.add(this.camera);
    const sun = new DirectionalLight("#fff4e0", 1.6);
    sun.position.set(3, 6, 4);
    this.scene.add(this.rig, this.ground, new HemisphereLight("#f2f6fa", "#9a958c", 1.9), sun);
  }

  /** Calls the listener before each frame is drawn. */
  onFrame(listener: FrameListener): void {
    this.listeners.push(listener);
  }

  /** Draws through another camera on the desktop; null: through the usual one. */
  useFlatCamera(camera: OrthographicCamera | null): void {
    this.flat = camera;
  }

  start(): void {
    this.resize();
    window.addEventListener("resize", () => this.resize());
    this.renderer.setAnimationLoop((time, frame) => this.draw(time, frame ?? null));
  }

  /** Writes the ray under a place of the page [CSS pixels] into `out`. */
  pointerRay(clientX: number, clientY: number, out: Ray): Ray {
    const box = this.canvas.getBoundingClientRect();
    const x = ((clientX - box.left) / box.width) * 2 - 1;
    const y = 1 - ((clientY - box.top) / box.height) * 2;
    const camera = this.flat ?? this.camera;
    camera.updateMatrixWorld();
    out.origin.set(x, y, -1).unproject(camera);
    out.direction.set(x, y, 1).unproject(camera).sub(out.origin).normalize();
    return out;
  }

  get presenting(): boolean {
    return this.renderer.xr.isPresenting;
  }

  private draw(time: number, frame: XRFrame | null): void {
    const seconds = Math.min(LONGEST_FRAME_S, Math.max(0, (time - this.last) / 1000));
    this.last = time;
    if (this.presenting) this.renderer.xr.updateCamera(this.camera);
    const camera = this.presenting ? this.camera : (this.flat ?? this.camera);
    camera.getWorldPosition(this.eye);
    for (let i = 0; i < this.listeners.length; i++) this.listeners[i](seconds, frame);
    this.renderer.info.reset();
    this.renderer.render(this.scene, camera);
    this.frames += 1;
  }

  private resize(): void {
    if (this.presenting) return;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
  }
}
