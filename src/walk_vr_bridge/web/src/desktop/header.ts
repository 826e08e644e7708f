// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The head of the page: which building, whether it is connected, the ways of looking, the headset, the help. */

import type { Client } from "../client/client";
import { element, icon, setText } from "../panel/element";
import type { IconName } from "../panel/icons";
import type { XrEntry } from "../xr/session";
import type { ViewpointName } from "./viewpoint";

export const VIEWS: readonly { name: ViewpointName; label: string; icon: IconName; hint: string }[] = [
  { name: "orbit", label: "Around", icon: "cube", hint: "Look at the building from outside (1)" },
  { name: "plan", label: "Plan", icon: "plan", hint: "A storey from above (2)" },
  { name: "walk", label: "Walk", icon: "walk", hint: "Walk through it (3)" },
];
const HEADSET_AGAIN_MS = 4000;

export interface HeaderPort {
  view(name: ViewpointName): void;
  help(): void;
}

export class Header {
  readonly root = element("header", "head");
  private readonly views = new Map<ViewpointName, HTMLButtonElement>();

  constructor(client: Client, xr: XrEntry, port: HeaderPort) {
    const views = element("div", "segments");
    views.setAttribute("role", "group");
    views.setAttribute("aria-label", "View");
    for (const { name, label, icon: drawing, hint } of VIEWS) {
      const button = iconButton(drawing, label, () => port.view(name));
      button.title = hint;
      button.dataset.view = name;
      this.views.set(name, button);
      views.append(button);
    }
    const help = iconButton("help", "Help", port.help);
    help.classList.add("round");
    this.root.append(title(client), views, headset(client, xr), help);
  }

  show(view: ViewpointName): void {
    for (const [name, button] of this.views) button.setAttribute("aria-pressed", String(name === view));
  }
}

function iconButton(drawing: IconName, label: string, run: () => void): HTMLButtonElement {
  const button = element("button");
  button.type = "button";
  button.setAttribute("aria-label", label);
  button.append(icon(drawing), element("span", "", label));
  button.addEventListener("click", run);
  return button;
}

function title(client: Client): HTMLElement {
  const root = element("div", "building");
  const name = element("strong");
  const state = element("span", "state");
  state.setAttribute("role", "status");
  root.append(name, state);
  const update = (): void => {
    const { building, connection, path, nodes } = client.store.state;
    setText(name, building ? building.name.replace(/\.\w+$/, "").replaceAll("_", " ") : "Walkthrough planner");
    root.dataset.phase = connection.phase;
    const trouble = nodes.find(({ level }) => level === "error");
    root.classList.toggle("trouble", connection.phase === "connected" && trouble !== undefined);
    root.title = trouble?.message ?? connection.message;
    const waiting = connection.unconfirmed > 0 ? " · saving …" : "";
    const walk = path.count > 0 ? `${path.lengthM.toFixed(0)} m · ${duration(path.durationS)}` : "no walk yet";
    const connected = trouble ? trouble.message : walk + waiting;
    setText(state, connection.phase === "connected" ? connected : phaseWord(connection.phase));
  };
  for (const slice of ["building", "connection", "path", "nodes"] as const) client.store.subscribe(slice, update);
  update();
  return root;
}

function duration(seconds: number): string {
  return seconds < 90 ? `${seconds.toFixed(0)} s` : `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
}

function phaseWord(phase: string): string {
  return (
    { connecting: "connecting …", waiting: "connection lost, trying again …", pairing: "waiting for the code" }[
      phase
    ] ?? "not connected"
  );
}

/** The button into the headset, where there is one; a headset may be plugged in later. */
function headset(client: Client, xr: XrEntry): HTMLElement {
  const button = iconButton("headset", "Enter headset", () => {
    xr.enter().catch((error: unknown) => client.complained(`The headset cannot be entered: ${String(error)}`));
  });
  button.className = "enter-xr";
  button.hidden = true;
  const look = async (): Promise<void> => {
    button.hidden = !(await xr.supported());
    if (button.hidden) setTimeout(() => void look(), HEADSET_AGAIN_MS);
  };
  void look();
  return button;
}
