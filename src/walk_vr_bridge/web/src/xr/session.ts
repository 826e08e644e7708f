// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import type { View } from "../scene/view";

const FEATURES: XRSessionInit = {
  requiredFeatures: ["local-floor"],
  optionalFeatures: ["bounded-floor", "hand-tracking", "layers"],
};

/** What one does is seen the sooner, the more frames there are; the page's budget of triangles is made for so many [1/s]. */
const FRAME_RATE = 90;

/** Why there is no headset here, in words; empty where there is one. */
export type XrObstacle = string;

/** The way into the headset and out of it. */
export class XrEntry {
  /** Called when a session begins or has ended. */
  onChange: ((inside: boolean) => void) | null = null;
  private session: XRSession | null = null;

  constructor(private readonly view: View) {}

  get inside(): boolean {
    return this.session !== null;
  }

  /** Returns what stands in the way of a session: no secure context, no WebXR, no headset. Empty: nothing. */
  async obstacle(): Promise<XrObstacle> {
    if (!window.isSecureContext) return "A headset needs https:// or localhost: open the address that the bridge printed.";
    if (!navigator.xr) return "This browser has no WebXR. Open the page in the headset's own browser.";
    const able = await navigator.xr.isSessionSupported("immersive-vr").catch(() => false);
    return able ? "" : "No headset is connected to this browser.";
  }

  async supported(): Promise<boolean> {
    return (await this.obstacle()) === "";
  }

  /** Begins a session; must be called from a click. @throws Error where the browser refuses. */
  async enter(): Promise<void> {
    if (this.session || !navigator.xr) return;
    const session = await navigator.xr.requestSession("immersive-vr", FEATURES);
    this.session = session;
    session.addEventListener("end", () => {
      this.session = null;
      this.onChange?.(false);
    });
    askForFrames(session);
    this.view.renderer.xr.setFoveation(1);
    await this.view.renderer.xr.setSession(session);
    this.onChange?.(true);
  }

  async leave(): Promise<void> {
    await this.session?.end();
  }
}

/** Asks for the highest rate that the page is made for; a headset that does not let itself be asked keeps its own. */
export function askForFrames(session: Pick<XRSession, "frameRate" | "supportedFrameRates" | "updateTargetFrameRate">): void {
  const fitting = Array.from(session.supportedFrameRates ?? []).filter((rate) => rate <= FRAME_RATE);
  const best = Math.max(0, ...fitting);
  if (best && best !== session.frameRate) session.updateTargetFrameRate(best).catch(() => undefined);
}
