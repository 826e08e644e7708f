// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import "./page.css";
import { browserClient } from "./client/client";
import { mountDesktop } from "./desktop/index";
import { XrPanel } from "./panel/xr_panel";
import { Stage } from "./scene/stage";
import { View } from "./scene/view";
import { XrRoom } from "./xr/room";
import { XrEntry } from "./xr/session";

async function start(canvas: HTMLCanvasElement): Promise<void> {
  const client = await browserClient();
  const view = new View(canvas);
  view.onFrame(() => client.look());
  const stage = new Stage(view, client.store);
  const xr = new XrEntry(view);
  const desktop = mountDesktop(view, stage, client, xr);
  const room = new XrRoom(view, stage, client.store, client.actions, new XrPanel(desktop.panel));
  xr.onChange = (inside) => room.setInside(inside);
  view.start();
  void client.start();
  Object.assign(window, { walk: { view, stage, client, xr, room, desktop } });
}

const canvas = document.querySelector<HTMLCanvasElement>("#view");
if (canvas) void start(canvas);
