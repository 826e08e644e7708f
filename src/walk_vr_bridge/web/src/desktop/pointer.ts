// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The pointer over the view: holds keypoints and moves them, adds, points at things, or moves the camera. */

import type { Client } from "../client/client";
import type { Keypoint, Vec3 } from "../client/state";
import { makeRay } from "../scene/place";
import type { Stage } from "../scene/stage";
import type { Ground } from "./ground";
import type { Viewpoint } from "./viewpoint";

/** A press that moves less than this is a click [px]. */
const CLICK_PX = 5;
/** How near a ray must pass to a keypoint: its radius times this, or this angle [rad] where that is more. */
const REACH = 1.35;
const REACH_TOUCH = 2.2;
const ANGLE = 0.008;

interface Press {
  readonly pointer: number;
  readonly x: number;
  readonly y: number;
  lastX: number;
  lastY: number;
  moved: boolean;
  readonly pan: boolean;
  readonly keypoint: Keypoint | null;
  /** The keypoint is in the hand. */
  held: boolean;
  /** From the keypoint's picture to where it was pressed [px]: it does not jump under the pointer. */
  place: Vec3 | null;
}

export class Pointer {
  private readonly presses = new Map<number, Press>();
  private readonly ray = makeRay();
  private spread = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly client: Client,
    private readonly ground: Ground,
    private readonly viewpoint: () => Viewpoint,
  ) {
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", (event) => this.cancel(event.pointerId));
    canvas.addEventListener("pointerleave", () => this.hover(null));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  /** Puts down where it was whatever is held. Returns whether something was. */
  letGo(): boolean {
    const held = [...this.presses.values()].some((press) => press.held);
    for (const id of [...this.presses.keys()]) this.cancel(id);
    return held;
  }

  /** The keypoint under a place of the page; null: none. */
  keypointAt(clientX: number, clientY: number, touch = false): Keypoint | null {
    const { stage, client } = this;
    const overlay = stage.overlayInView();
    overlay.place.rayToMap(stage.view.pointerRay(clientX, clientY, this.ray));
    const angle = this.viewpoint().name === "plan" ? 0 : ANGLE;
    const reach = overlay.size * (touch ? REACH_TOUCH : REACH);
    const { keypoints } = client.store.state;
    const id = overlay.place.pointedAt(keypoints, reach, angle, Infinity, (keypoint) => this.hidden(keypoint));
    return id === null ? null : (keypoints.find((keypoint) => keypoint.id === id) ?? null);
  }

  private hidden({ position: [x, y, z] }: Keypoint): boolean {
    const { clip } = this.stage.miniature;
    return this.stage.mode === "model" && clip.active && !clip.keepsOnFloor(x, y, z - this.stage.eyeHeightM);
  }

  private down(event: PointerEvent): void {
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    const { clientX: x, clientY: y } = event;
    const pan = event.button !== 0 || event.shiftKey;
    const single = this.presses.size === 0 && !pan && this.client.store.state.selection.tool === "edit";
    const keypoint = single ? this.keypointAt(x, y, event.pointerType === "touch") : null;
    this.presses.set(event.pointerId, {
      pointer: event.pointerId,
      x,
      y,
      lastX: x,
      lastY: y,
      moved: false,
      pan,
      keypoint,
      held: false,
      place: null,
    });
    this.spread = this.pinchSpread();
  }

  private move(event: PointerEvent): void {
    const press = this.presses.get(event.pointerId);
    if (!press) {
      if (event.pointerType !== "touch") this.hover(this.keypointAt(event.clientX, event.clientY));
      return;
    }
    const [dx, dy] = [event.clientX - press.lastX, event.clientY - press.lastY];
    press.moved ||= Math.hypot(event.clientX - press.x, event.clientY - press.y) > CLICK_PX;
    if (!press.moved) return;
    press.lastX = event.clientX;
    press.lastY = event.clientY;
    if (this.presses.size === 2) this.pinch(dx, dy);
    else if (press.keypoint) this.dragKeypoint(press, event);
    else this.viewpoint().drag(dx, dy, press.pan);
  }

  private dragKeypoint(press: Press, event: PointerEvent): void {
    const { actions, store } = this.client;
    const keypoint = press.keypoint!;
    if (store.state.session.role !== "editor") return;
    if (!press.held) {
      press.held = true;
      actions.grab(keypoint.id);
    }
    const { place } = this.stage.overlayInView();
    const z = press.place?.[2] ?? keypoint.position[2];
    const at = this.ground.dragged(event.clientX, event.clientY, z, place.belowEyeM);
    if (!at) return;
    press.place = at;
    actions.drag(keypoint.id, at);
  }

  private up(event: PointerEvent): void {
    const press = this.presses.get(event.pointerId);
    if (!press) return;
    this.presses.delete(event.pointerId);
    this.spread = this.pinchSpread();
    if (press.held && press.place) void this.client.actions.release(press.keypoint!.id, press.place);
    else if (press.held) this.client.actions.cancel(press.keypoint!.id);
    else if (!press.moved && !press.pan) this.click(press, event);
  }

  private click(press: Press, event: PointerEvent): void {
    const { actions, store } = this.client;
    const { tool, keypoint: chosen } = store.state.selection;
    if (tool === "add") {
      const at = this.ground.eyeUnder(event.clientX, event.clientY);
      if (at) void actions.add(at);
      actions.useTool("edit");
    } else if (tool === "lookAt" && chosen !== null) {
      const at = this.ground.surfaceUnder(event.clientX, event.clientY);
      if (at) void actions.lookAt(chosen, at);
      actions.useTool("edit");
    } else {
      actions.select(press.keypoint?.id ?? null);
    }
  }

  private cancel(pointer: number): void {
    const press = this.presses.get(pointer);
    this.presses.delete(pointer);
    if (press?.held) this.client.actions.cancel(press.keypoint!.id);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const px = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY * 30 : event.deltaY;
    const factor = Math.exp(Math.max(-200, Math.min(200, px)) * 0.0016);
    this.viewpoint().zoom(factor, event.clientX, event.clientY);
  }

  private pinchSpread(): number {
    const [a, b] = [...this.presses.values()];
    return a && b ? Math.hypot(a.lastX - b.lastX, a.lastY - b.lastY) : 0;
  }

  private pinch(dx: number, dy: number): void {
    const [a, b] = [...this.presses.values()];
    const spread = this.pinchSpread();
    if (!a || !b || spread < 1) return;
    this.viewpoint().drag(dx / 2, dy / 2, true);
    if (this.spread > 0) this.viewpoint().zoom(this.spread / spread, (a.lastX + b.lastX) / 2, (a.lastY + b.lastY) / 2);
    this.spread = spread;
  }

  private hover(keypoint: Keypoint | null): void {
    this.stage.hover = keypoint?.id ?? null;
    const aiming = this.client.store.state.selection.tool !== "edit";
    this.canvas.style.cursor = aiming ? "crosshair" : keypoint ? (keypoint.locked ? "not-allowed" : "grab") : "";
  }
}
