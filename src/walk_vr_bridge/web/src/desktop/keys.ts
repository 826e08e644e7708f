// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The keyboard: what it does over the view, and the list of it that the help shows. */

import type { Client } from "../client/client";
import type { Stroll } from "./stroll";
import type { Viewpoint, ViewpointName } from "./viewpoint";

/** How far an arrow moves the chosen keypoint [m]. */
const NUDGE_M = 0.25;
const ORBIT_PX = 40;

export const KEYS: readonly (readonly [string, string])[] = [
  ["1 · 2 · 3", "around, plan, walk"],
  ["Page up · Page down", "storey above, below"],
  ["F", "show all"],
  ["Arrow keys", "turn or move the view; walk"],
  ["W A S D", "walk (Shift: faster)"],
  ["N", "new keypoint: then click a floor"],
  ["Alt + arrow keys", "move the chosen keypoint by 25 cm"],
  ["Delete", "delete the chosen keypoint"],
  ["L", "lock or unlock it"],
  ["Ctrl + Z · Ctrl + Y", "undo, redo"],
  ["Space", "play or pause the walkthrough"],
  ["Esc", "put back, stop adding, choose nothing"],
  ["?", "this help"],
];

export interface KeyPort {
  readonly client: Client;
  readonly stroll: Stroll;
  viewpoint(): Viewpoint;
  view(name: ViewpointName): void;
  storey(by: number): void;
  add(): void;
  /** Puts back what the pointer holds; false where it holds nothing. */
  letGo(): boolean;
  help(): void;
}

const WALK: Readonly<Record<string, "forward" | "back" | "left" | "right">> = {
  KeyW: "forward",
  ArrowUp: "forward",
  KeyS: "back",
  ArrowDown: "back",
  KeyA: "left",
  ArrowLeft: "left",
  KeyD: "right",
  ArrowRight: "right",
};
const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
};

export function listenToKeys(port: KeyPort): void {
  window.addEventListener("keydown", (event) => {
    if (typing(event)) return;
    if (pressed(event, port)) event.preventDefault();
  });
  window.addEventListener("keyup", (event) => {
    const way = WALK[event.code];
    if (way) port.stroll.keys[way] = 0;
    port.stroll.keys.fast = event.shiftKey ? 1 : 0;
  });
  window.addEventListener("blur", () =>
    Object.assign(port.stroll.keys, { forward: 0, back: 0, left: 0, right: 0, fast: 0 }),
  );
}

/** Whether the key belongs to a control of the page. */
function typing(event: KeyboardEvent): boolean {
  const target = event.target;
  if (!(target instanceof HTMLElement) || document.querySelector("dialog[open]")) return true;
  if (target.closest("input, textarea, select, [role=tablist]")) return true;
  return target.closest("button") !== null && (event.key === " " || event.key === "Enter");
}

function pressed(event: KeyboardEvent, port: KeyPort): boolean {
  const { actions, store } = port.client;
  const { selection, playback, session } = store.state;
  const editor = session.role === "editor";
  if (event.ctrlKey || event.metaKey) return editor && history(event, port);
  if (event.altKey) return editor && nudge(event, port);
  if (moveView(event, port)) return true;
  switch (event.key) {
    case "1":
    case "2":
    case "3":
      return port.view((["orbit", "plan", "walk"] as const)[Number(event.key) - 1]!), true;
    case "PageUp":
    case "PageDown":
      return port.storey(event.key === "PageUp" ? 1 : -1), true;
    case "f":
      return port.viewpoint().fit(), true;
    case "n":
      return editor && (port.add(), true);
    case "l":
      return editor && lock(port);
    case "Delete":
    case "Backspace":
      return editor && selection.keypoint !== null && (void actions.remove(selection.keypoint), true);
    case " ":
      return editor && (void (playback.playing ? actions.pause() : actions.play()), true);
    case "Escape":
      return escape(port);
    case "?":
      return port.help(), true;
    default:
      return false;
  }
}

function history(event: KeyboardEvent, { client }: KeyPort): boolean {
  const key = event.key.toLowerCase();
  if (key === "z") void (event.shiftKey ? client.actions.redo() : client.actions.undo());
  else if (key === "y") void client.actions.redo();
  else return false;
  return true;
}

function chosen({ client }: KeyPort) {
  const { selection, keypoints } = client.store.state;
  return keypoints.find(({ id }) => id === selection.keypoint) ?? null;
}

function nudge(event: KeyboardEvent, port: KeyPort): boolean {
  const way = ARROWS[event.key];
  const keypoint = chosen(port);
  if (!way || !keypoint) return false;
  const [x, y, z] = keypoint.position;
  void port.client.actions.release(keypoint.id, [x + NUDGE_M * way[0], y + NUDGE_M * way[1], z]);
  return true;
}

function lock(port: KeyPort): boolean {
  const keypoint = chosen(port);
  if (!keypoint) return false;
  void (keypoint.locked ? port.client.actions.unlock(keypoint.id) : port.client.actions.lock(keypoint.id));
  return true;
}

function moveView(event: KeyboardEvent, port: KeyPort): boolean {
  const viewpoint = port.viewpoint();
  if (viewpoint.name === "walk") {
    const way = WALK[event.code];
    port.stroll.keys.fast = event.shiftKey ? 1 : 0;
    if (way) port.stroll.keys[way] = 1;
    return way !== undefined;
  }
  const arrow = ARROWS[event.key];
  if (arrow) viewpoint.drag(-arrow[0] * ORBIT_PX, arrow[1] * ORBIT_PX, event.shiftKey);
  return arrow !== undefined;
}

function escape(port: KeyPort): boolean {
  const { actions, store } = port.client;
  if (port.letGo()) return true;
  if (store.state.selection.tool !== "edit") actions.useTool("edit");
  else actions.select(null);
  return true;
}
