// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The panel: one model that the desktop's elements and the headset's picture are both drawn from. */

import type { Client } from "../client/client";
import { playbackTimeS } from "../client/playback";
import type { Slice, State } from "../client/state";
import type { StudyView } from "../study/view";
import { button } from "./buttons";
import { tourSections } from "./tour";
import { tuneSections } from "./tune";
import { viewSections } from "./view";
import { walkSections } from "./walk";
import type { Section, TabId } from "./widgets";

const SLICES: readonly Slice[] = [
  "connection",
  "session",
  "building",
  "keypoints",
  "path",
  "importance",
  "parameters",
  "playback",
  "settings",
  "selection",
  "offer",
  "loading",
];
/** While it plays, the time shown moves on this often. */
const TICK_MS = 250;

export class PanelModel {
  private current: TabId = "tour";
  private readonly listeners = new Set<() => void>();
  private due = false;

  constructor(
    readonly client: Pick<Client, "store" | "actions" | "retry">,
    private readonly study: StudyView,
    private readonly defer: (run: () => void) => void = (run) => void setTimeout(run, 0),
  ) {
    for (const slice of SLICES) client.store.subscribe(slice, () => this.changed());
    study.onChange(() => this.changed());
  }

  get tab(): TabId {
    return this.current;
  }

  open(tab: TabId): void {
    this.current = tab;
    this.changed();
  }

  /** Calls the listener, once for many changes at one time; returns what ends that. */
  onChange(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Lets the time move while it plays; returns what ends that. */
  startClock(): () => void {
    const timer = setInterval(() => {
      if (this.state.playback.playing && this.current === "walk") this.changed();
    }, TICK_MS);
    return () => clearInterval(timer);
  }

  /** What the open tab shows now. Sections without widgets are left out. */
  sections(nowMs = Date.now()): Section[] {
    const sections = [this.connectionSection(), ...this.tabSections(nowMs)];
    return sections.filter(({ widgets }) => widgets.length > 0);
  }

  private get state(): State {
    return this.client.store.state;
  }

  private tabSections(nowMs: number): Section[] {
    const { actions } = this.client;
    switch (this.current) {
      case "tour":
        return tourSections(this.state, actions);
      case "view":
        return viewSections(this.state, actions);
      case "tune":
        return tuneSections(this.state, actions);
      case "walk":
        return walkSections(this.state, actions, playbackTimeS(this.state.playback, nowMs));
      case "study":
        return this.study.sections();
    }
  }

  /** Says so where edits do not reach the planner at the moment, or nobody may make any. */
  private connectionSection(): Section {
    const { connection, session } = this.state;
    const section: Section = { id: "connection", title: "", widgets: [] };
    if (connection.phase !== "connected") {
      const retry = button("retry", "Try now", () => this.client.retry());
      // Red is for what has come to an end; what is tried again needs nobody.
      const tone = connection.phase === "refused" ? "warn" : connection.message === "Connecting …" ? "plain" : "wait";
      const widgets = [{ kind: "note", id: "connection", text: connection.message, tone } as const];
      return { ...section, widgets: connection.phase === "waiting" ? [...widgets, retry] : widgets };
    }
    if (session.role === "editor") return section;
    const text = "You are a viewer: you see everything and change nothing.";
    return { ...section, widgets: [{ kind: "note", id: "viewer", text, tone: "plain" }] };
  }

  private changed(): void {
    if (this.due) return;
    this.due = true;
    this.defer(() => {
      this.due = false;
      for (const listener of this.listeners) listener();
    });
  }
}
