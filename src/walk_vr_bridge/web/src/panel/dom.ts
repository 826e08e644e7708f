// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The panel on the page: tabs and sections as elements, brought up to date when the model changes. */

import type { Shown } from "./dom_controls";
import { makeWidget, type DomPort } from "./dom_widgets";
import { element, icon, setText } from "./element";
import type { PanelModel } from "./model";
import { TABS, type Section, type TabId } from "./widgets";

interface ShownSection {
  readonly root: HTMLElement;
  readonly title: HTMLElement;
  readonly widgets: Map<string, { kind: string; shown: Shown }>;
}

export class DomPanel {
  readonly root = element("aside", "panel");
  private readonly body = element("div", "panel-body");
  private readonly tabs = new Map<TabId, HTMLButtonElement>();
  private readonly sections = new Map<string, ShownSection>();
  private shownTab: TabId | null = null;
  private resting = false;

  constructor(
    private readonly model: PanelModel,
    private readonly port: DomPort,
  ) {
    this.root.setAttribute("aria-label", "Panel");
    this.body.id = "panel-body";
    this.body.setAttribute("role", "tabpanel");
    this.root.append(this.tabList(), this.body);
    model.onChange(() => {
      if (!this.resting) this.update();
    });
    this.update();
  }

  /** While nobody sees the page, as in a headset, it is not brought up to date either. */
  rest(resting: boolean): void {
    this.resting = resting;
    if (!resting) this.update();
  }

  private tabList(): HTMLElement {
    const list = element("div", "tabs");
    list.setAttribute("role", "tablist");
    for (const { id, label, icon: name } of TABS) {
      const tab = element("button");
      tab.type = "button";
      tab.setAttribute("role", "tab");
      tab.setAttribute("aria-controls", this.body.id);
      tab.dataset.tab = id;
      tab.append(icon(name), element("span", "", label));
      tab.addEventListener("click", () => this.model.open(id));
      this.tabs.set(id, tab);
      list.append(tab);
    }
    list.addEventListener("keydown", (event) => this.moveTab(event));
    return list;
  }

  private moveTab(event: KeyboardEvent): void {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by) return;
    const index = TABS.findIndex(({ id }) => id === this.model.tab);
    const next = TABS[(index + by + TABS.length) % TABS.length]!.id;
    this.model.open(next);
    this.tabs.get(next)!.focus();
  }

  private update(): void {
    const open = this.model.tab;
    for (const [id, tab] of this.tabs) {
      tab.setAttribute("aria-selected", String(id === open));
      tab.tabIndex = id === open ? 0 : -1;
    }
    if (open !== this.shownTab) {
      this.body.replaceChildren();
      this.sections.clear();
      this.body.scrollTop = 0;
      this.shownTab = open;
    }
    const sections = this.model.sections();
    for (const [id, { root }] of this.sections) {
      if (sections.some((section) => section.id === id)) continue;
      root.remove();
      this.sections.delete(id);
    }
    sections.forEach((section, index) => this.updateSection(section, index));
  }

  private updateSection(section: Section, index: number): void {
    const shown = this.sections.get(section.id) ?? this.makeSection(section.id);
    place(this.body, shown.root, index);
    setText(shown.title, section.title);
    shown.title.hidden = section.title === "";
    const keys = new Set(section.widgets.map(({ id }) => id));
    for (const [id, { shown: gone }] of shown.widgets) {
      if (keys.has(id)) continue;
      gone.root.remove();
      shown.widgets.delete(id);
    }
    section.widgets.forEach((widget, position) => {
      let known = shown.widgets.get(widget.id);
      if (known?.kind !== widget.kind) {
        known?.shown.root.remove();
        known = { kind: widget.kind, shown: makeWidget(widget, this.port) };
        shown.widgets.set(widget.id, known);
      } else {
        known.shown.update(widget);
      }
      // The title is the first child.
      place(shown.root, known.shown.root, position + 1);
    });
  }

  private makeSection(id: string): ShownSection {
    const root = element("section", "section");
    root.dataset.section = id;
    const title = element("h2");
    root.append(title);
    const made = { root, title, widgets: new Map() };
    this.sections.set(id, made);
    return made;
  }
}

/** Puts a child at an index; one that is there already keeps its focus. */
function place(parent: HTMLElement, child: HTMLElement, index: number): void {
  if (parent.children[index] !== child) parent.insertBefore(child, parent.children[index] ?? null);
}
