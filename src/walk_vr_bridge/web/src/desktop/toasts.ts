// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Refusals, said where they happened: beside the place where it is in the picture, else at the foot of the view. */

import { type Camera, Vector3 } from "three";
import type { Client } from "../client/client";
import type { Refusal } from "../client/state";
import { sentence } from "../client/words";
import { element } from "../panel/element";
import type { Stage } from "../scene/stage";
import type { View } from "../scene/view";

/** A toast goes by itself after this time; while it is pointed at or has the focus, the time begins anew. */
const SHOWN_MS = 10_000;
const MOST = 3;
/** A toast stands over its place, and still below the head of the page. */
const LEAST_TOP_PX = 190;

interface Toast {
  readonly refusal: Refusal;
  readonly root: HTMLElement;
  sinceMs: number;
}

export class Toasts {
  readonly root = element("div", "toasts");
  private toasts: Toast[] = [];
  private last = 0;

  constructor(
    private readonly view: View,
    private readonly stage: Stage,
    private readonly client: Client,
    private readonly camera: () => Camera,
  ) {
    this.root.setAttribute("role", "alert");
    client.store.subscribe("refusals", () => this.take());
  }

  /** Once a frame: keeps each at its place. */
  frame(): void {
    if (this.toasts.length === 0) return;
    const now = Date.now();
    for (const toast of [...this.toasts]) {
      if (toast.root.matches(":hover, :focus-within")) toast.sinceMs = now;
      if (now - toast.sinceMs > SHOWN_MS) this.drop(toast);
      else this.put(toast);
    }
  }

  private take(): void {
    const { refusals } = this.client.store.state;
    for (const refusal of refusals) {
      if (refusal.serial <= this.last) continue;
      this.last = refusal.serial;
      this.show(refusal);
    }
    for (const toast of [...this.toasts]) if (!refusals.includes(toast.refusal)) this.drop(toast);
    while (this.toasts.length > MOST) this.drop(this.toasts[0]!);
  }

  private show(refusal: Refusal): void {
    const root = element("div", "toast");
    const close = element("button", "", "×");
    close.type = "button";
    close.setAttribute("aria-label", "Dismiss");
    close.addEventListener("click", () => this.client.actions.dismissRefusal(refusal.serial));
    root.append(element("span", "", sentence(refusal.reason)), close);
    this.root.append(root);
    const toast = { refusal, root, sinceMs: refusal.atMs };
    this.toasts.push(toast);
    this.put(toast);
  }

  private put({ refusal, root }: Toast): void {
    const at = refusal.place && this.onPage(refusal.place);
    root.classList.toggle("placed", Boolean(at));
    root.style.left = at ? `${at.x}px` : "";
    root.style.top = at ? `${at.y}px` : "";
  }

  /** Where a place of the map is on the page; null where it is not in the picture. */
  private onPage([x, y, z]: readonly [number, number, number]): { x: number; y: number } | null {
    const canvas = this.view.renderer.domElement;
    this.stage.overlayInView().place.shown([x, y, z], AT);
    AT.project(this.camera());
    if (Math.abs(AT.x) > 0.95 || Math.abs(AT.y) > 0.95 || AT.z > 1) return null;
    const px = ((AT.x + 1) / 2) * canvas.clientWidth;
    const half = Math.min(170, canvas.clientWidth / 2 - 12);
    return {
      x: Math.min(canvas.clientWidth - half - 8, Math.max(half + 8, px)),
      y: Math.max(LEAST_TOP_PX, ((1 - AT.y) / 2) * canvas.clientHeight),
    };
  }

  private drop(toast: Toast): void {
    toast.root.remove();
    this.toasts = this.toasts.filter((other) => other !== toast);
  }
}

const AT = new Vector3();
