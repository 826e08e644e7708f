// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The storeys, one over the other as they stand, at the left edge. */

import type { Client } from "../client/client";
import { element } from "../panel/element";
import type { ViewpointName } from "./viewpoint";

export class StoreyRail {
  readonly root = element("nav", "storeys");
  private drawn = "";

  constructor(
    private readonly client: Client,
    private readonly view: () => ViewpointName,
  ) {
    this.root.setAttribute("aria-label", "Storeys");
    for (const slice of ["building", "selection"] as const) client.store.subscribe(slice, () => this.update());
    this.update();
  }

  update(): void {
    const { building, selection } = this.client.store.state;
    const storeys = building?.storeys ?? [];
    const all = this.view() === "orbit";
    this.root.hidden = storeys.length === 0 || this.view() === "walk";
    const look = JSON.stringify([all, building?.hash]);
    if (look !== this.drawn) {
      this.drawn = look;
      const buttons = storeys.map(({ name, floorZ }, index) =>
        this.button(name, `floor at ${floorZ.toFixed(2)} m`, index),
      );
      this.root.replaceChildren(...(all ? [this.button("All", "the whole building", -1)] : []), ...buttons.reverse());
    }
    for (const child of this.root.children as HTMLCollectionOf<HTMLElement>) {
      child.setAttribute("aria-pressed", String(Number(child.dataset.storey) === selection.storey));
    }
  }

  private button(label: string, hint: string, storey: number): HTMLElement {
    const button = element("button", "", label);
    button.type = "button";
    button.title = hint;
    button.dataset.storey = String(storey);
    button.addEventListener("click", () => this.client.actions.showStorey(storey));
    return button;
  }
}
