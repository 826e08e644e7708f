// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A keypoint that is dragged out of the panel: a pin goes with the pointer, and is put where it is let go. */

import type { Client } from "../client/client";
import { element } from "../panel/element";
import type { Ground } from "./ground";

const BEGIN_PX = 6;

/** Returns what begins such a drag. @param prepare called when it begins: shows a floor to drop it on. */
export function dragOut(
  canvas: HTMLCanvasElement,
  client: Client,
  ground: Ground,
  prepare: () => void,
): (event: PointerEvent) => void {
  return (start) => {
    if (start.button !== 0) return;
    const ghost = element("div", "ghost");
    const ended = new AbortController();
    const { signal } = ended;
    let begun = false;
    const move = (event: PointerEvent): void => {
      if (!begun && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < BEGIN_PX) return;
      if (!begun) {
        begun = true;
        prepare();
        document.body.append(ghost);
      }
      event.preventDefault();
      ghost.style.transform = `translate(${event.clientX}px, ${event.clientY}px)`;
      ghost.classList.toggle("over", overCanvas(canvas, event));
    };
    const end = (): void => {
      ended.abort();
      ghost.remove();
    };
    const up = (event: PointerEvent): void => {
      end();
      if (!begun || !overCanvas(canvas, event)) return;
      const at = ground.eyeUnder(event.clientX, event.clientY);
      if (at) void client.actions.add(at);
    };
    // A touch that scrolls instead would take the pointer away.
    (start.target as Element | null)?.releasePointerCapture?.(start.pointerId);
    window.addEventListener("pointermove", move, { signal });
    window.addEventListener("pointerup", up, { signal });
    window.addEventListener("pointercancel", end, { signal });
    window.addEventListener("keydown", (event) => event.key === "Escape" && end(), { signal });
  };
}

function overCanvas(canvas: HTMLCanvasElement, event: PointerEvent): boolean {
  return document.elementFromPoint(event.clientX, event.clientY) === canvas;
}
