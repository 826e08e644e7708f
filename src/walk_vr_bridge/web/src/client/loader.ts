// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Keeps building and importance volume of the store at what the bridge announces. */

import type { Files as Announced } from "./answers";
import { buildingFrom, FileError, importanceFrom, patient, volumeFrom, type Fetch } from "./files";
import type { Store } from "./store";

const CHANGED = 409;

export class Files {
  /** Rises with each round: an older one that is still waiting ends. */
  private buildingRound = 0;
  private importanceRound = 0;
  private announcedEtag = "";
  private alive = true;

  constructor(
    private readonly store: Store,
    private readonly get: Fetch = (url) => fetch(url),
  ) {}

  /** Asks for the building if it is not there. */
  start(): void {
    this.alive = true;
    if (!this.store.state.building) void this.readBuilding();
  }

  stop(): void {
    this.alive = false;
  }

  announced(files: Announced): void {
    const { building, importance } = this.store.state;
    if (
      files.buildingEtag &&
      files.buildingEtag !== building?.model.etag &&
      files.buildingEtag !== this.announcedEtag
    ) {
      this.announcedEtag = files.buildingEtag;
      void this.readBuilding();
    }
    if (!files.importance) this.store.set("importance", null);
    else if (files.importance !== importance?.revision) void this.readImportance();
  }

  private async readBuilding(): Promise<void> {
    const round = ++this.buildingRound;
    const current = (): boolean => this.alive && round === this.buildingRound;
    try {
      const answer = await patient(this.get, "/building.json", current, () =>
        this.store.patch("loading", { building: "The building is loading …", failed: false }),
      );
      if (!answer || !current()) return;
      this.store.set("building", buildingFrom(await answer.json()));
      this.store.patch("loading", { building: "", failed: false });
    } catch (error) {
      if (current()) this.store.patch("loading", { building: sentence(error), failed: true });
    }
  }

  private async readImportance(): Promise<void> {
    const round = ++this.importanceRound;
    const current = (): boolean => this.alive && round === this.importanceRound;
    try {
      const answer = await patient(this.get, "/importance.json", current, () => undefined);
      if (!answer || !current()) return;
      const file = importanceFrom(await answer.json());
      const volume = await this.get(file.url);
      // A newer map has come in between: its own announcement brings it.
      if (!current() || volume.status === CHANGED) return;
      if (!volume.ok) throw new FileError(`The importance map cannot be read (${volume.status}).`);
      this.store.set("importance", volumeFrom(file, await volume.arrayBuffer()));
      this.store.patch("loading", { importance: "" });
    } catch (error) {
      if (current()) this.store.patch("loading", { importance: sentence(error) });
    }
  }
}

function sentence(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
