// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The page for mouse and keyboard: everything the headset has, around the same scene. */

import "./desktop.css";
import type { Camera } from "three";
import type { Client } from "../client/client";
import { PathMeasurer } from "../client/measure";
import { DomPanel } from "../panel/dom";
import { PanelModel } from "../panel/model";
import { element } from "../panel/element";
import type { Stage } from "../scene/stage";
import type { View } from "../scene/view";
import { StudyView } from "../study/view";
import type { XrEntry } from "../xr/session";
import { coveredBy, type Covered } from "./covered";
import { curtain, help, pairing } from "./dialogs";
import { dragOut } from "./drag_out";
import { Ground } from "./ground";
import { Header } from "./header";
import { listenToKeys } from "./keys";
import { Orbit } from "./orbit";
import { Plan } from "./plan";
import { Playbar } from "./playbar";
import { Pointer } from "./pointer";
import { StoreyRail } from "./rail";
import { download } from "./save";
import { Stroll } from "./stroll";
import { Toasts } from "./toasts";
import type { Viewpoint, ViewpointName } from "./viewpoint";

/** What measuring along the path may take of a frame, as a part of it: where frames are slow, more is measured in each. */
const MEASURE_PART = 0.2;
/** In a headset a frame has a ninetieth of a second for everything [ms]. */
const MEASURE_XR_MS = 1;

export class Desktop {
  readonly panel: PanelModel;
  readonly study: StudyView;
  private readonly viewpoints: Record<ViewpointName, Viewpoint>;
  private current: Viewpoint;
  private readonly stroll: Stroll;
  private readonly rail: StoreyRail;
  private readonly header: Header;
  private readonly domPanel: DomPanel;
  private readonly page = element("div", "desktop");
  private presenting = false;
  private riding = false;
  private playing = false;
  private covered: Covered = { left: 0, right: 0, top: 0, bottom: 0 };

  constructor(
    private readonly view: View,
    private readonly stage: Stage,
    private readonly client: Client,
    xr: XrEntry,
  ) {
    const canvas = view.renderer.domElement;
    canvas.tabIndex = 0;
    this.study = new StudyView(client, download);
    this.panel = new PanelModel(client, this.study);
    this.panel.startClock();
    const playbar = new Playbar(client).root;
    const covered = (): Covered => this.covered;
    this.stroll = new Stroll(view, stage);
    this.viewpoints = {
      orbit: new Orbit(view, stage, covered),
      plan: new Plan(view, stage, covered),
      walk: this.stroll,
    };
    this.current = this.viewpoints.orbit;
    const ground = new Ground(stage);
    const pointer = new Pointer(canvas, stage, client, ground, () => this.current);
    this.domPanel = new DomPanel(this.panel, { dragOut: dragOut(canvas, client, ground, () => this.openStorey()) });
    const guide = help();
    const showHelp = (): void => guide.showModal();
    this.header = new Header(client, xr, { view: (name) => this.show(name), help: showHelp });
    this.rail = new StoreyRail(client, () => this.current.name);
    const toasts = new Toasts(view, stage, client, () => this.current.camera);
    const parts = [this.header.root, this.rail.root, this.domPanel.root, playbar, toasts.root];
    this.page.append(...parts, curtain(client), pairing(client), guide);
    document.querySelector("#page")!.append(this.page);
    this.watchCovered(playbar);
    listenToKeys({
      client,
      stroll: this.stroll,
      viewpoint: () => this.current,
      view: (name) => this.show(name),
      storey: (by) => this.moveStorey(by),
      add: () => client.actions.useTool("add"),
      letGo: () => pointer.letGo(),
      help: showHelp,
    });
    this.followStore(canvas);
    const measurer = new PathMeasurer(client.store, () => stage.models?.obstacles ?? null);
    view.onFrame((s) => measurer.step(view.presenting ? MEASURE_XR_MS : 1000 * MEASURE_PART * s));
    view.onFrame((seconds) => this.frame(seconds, toasts));
    this.show("orbit");
  }

  /** Measures what the page covers when it changes, not each frame. */
  private watchCovered(playbar: Element): void {
    const parts = { head: this.header.root, rail: this.rail.root, panel: this.domPanel.root, playbar };
    const observer = new ResizeObserver(() => (this.covered = coveredBy(parts)));
    for (const part of Object.values(parts)) observer.observe(part);
    this.covered = coveredBy(parts);
  }

  get viewName(): ViewpointName {
    return this.current.name;
  }

  /** What the picture is drawn through. */
  get camera(): Camera {
    return this.current.camera;
  }

  /** Looks another way. */
  show(name: ViewpointName): void {
    if (this.viewpoints[name] !== this.current) this.current.leave();
    this.current = this.viewpoints[name];
    this.page.dataset.view = name;
    this.current.enter();
    this.header.show(name);
    this.rail.update();
  }

  private followStore(canvas: HTMLCanvasElement): void {
    const { store } = this.client;
    let firstBuilding = true;
    store.subscribe("building", () => {
      const { building } = store.state;
      if (!building || !firstBuilding) return;
      firstBuilding = false;
      // Opened like a doll's house on the storey where a visit begins: what is edited is seen at once.
      this.client.actions.showStorey(this.stage.storeyAt(building.start[2]));
    });
    store.subscribe("selection", () => {
      const { tool } = store.state.selection;
      canvas.style.cursor = tool === "edit" ? "" : "crosshair";
      if (tool === "add") this.openStorey();
    });
    store.subscribe("settings", () => this.ride());
    store.subscribe("playback", () => this.ride());
  }

  /** Who walks along is inside, and who is inside walks along. */
  private ride(): void {
    if (this.presenting) return;
    const { playback, settings } = this.client.store.state;
    const riding = playback.playing && settings.playbackPlace === "ride";
    // Only as it begins: who looks another way or goes there meanwhile is left alone.
    const begins = playback.playing && !this.playing;
    if (riding !== this.riding) this.stroll.along = riding;
    if (begins && this.current === this.stroll) this.stroll.along = true;
    if (riding && !this.riding) this.show("walk");
    this.riding = riding;
    this.playing = playback.playing;
  }

  /** Opens a storey where none is open: on a roof nothing can be added. */
  private openStorey(): void {
    const { building, selection } = this.client.store.state;
    if (building && selection.storey < 0 && this.current.name === "orbit") {
      this.client.actions.showStorey(this.stage.storeyAt(building.start[2]));
    }
  }

  private moveStorey(by: number): void {
    const { building, selection } = this.client.store.state;
    if (!building) return;
    const lowest = this.current.name === "orbit" ? -1 : 0;
    const next = Math.min(building.storeys.length - 1, Math.max(lowest, selection.storey + by));
    this.client.actions.showStorey(next);
  }

  private frame(seconds: number, toasts: Toasts): void {
    if (this.view.presenting !== this.presenting) {
      this.presenting = this.view.presenting;
      this.page.hidden = this.presenting;
      this.domPanel.rest(this.presenting);
      if (this.presenting) this.current.leave();
      else this.current.enter();
    }
    if (this.presenting) return;
    this.current.frame(seconds);
    // Here refusals are elements of the page, which read better than a picture.
    this.stage.refusalNote.hide();
    toasts.frame();
  }
}

export function mountDesktop(view: View, stage: Stage, client: Client, xr: XrEntry): Desktop {
  return new Desktop(view, stage, client, xr);
}
