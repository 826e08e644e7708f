// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { type Box3, type BufferGeometry, type Data3DTexture, Plane, Vector3 } from "three";
import type { ChannelName } from "../client/state";
import type { Store } from "../client/store";
import type { Clip } from "./clipping";
import type { MapView } from "./mapview";
import type { StageMode } from "./stage";
import { choosePoints, makeTexture } from "./volume";

/** The map that the user chose, in the full scale and in the miniature; texture and points are made once a revision. */
export class Maps {
  private texture: Data3DTexture | null = null;
  private revision = "";
  private readonly points = new Map<ChannelName, BufferGeometry>();
  private shown = "";
  private readonly carpet = new Plane(new Vector3(0, 0, -1), 0);
  private readonly middle = new Vector3();
  private readonly size = new Vector3();

  constructor(
    private readonly store: Store,
    private readonly full: MapView,
    private readonly miniature: MapView,
  ) {
    store.subscribe("importance", () => this.choose());
    store.subscribe("settings", () => this.choose());
    this.choose();
  }

  /** Once a frame: lays the slices along the miniature's cut and on the floor that the viewer stands on [m]. */
  update(clip: Clip, bounds: Box3, floorZ: number, mode: StageMode): void {
    if (!this.shown) return;
    bounds.getCenter(this.middle);
    const width = 1.5 * bounds.getSize(this.size).length();
    this.miniature.setSlice(clip.active ? clip.plane : null, this.middle, width);
    this.miniature.showPoints(!clip.active);
    this.miniature.setPointSize(mode === "room" ? 4 : 160);
    this.carpet.constant = floorZ + 0.03;
    this.full.setSlice(this.carpet, this.middle, width);
    this.full.setPointSize(24);
  }

  private choose(): void {
    const { importance, settings } = this.store.state;
    if (importance?.revision !== this.revision) this.forget();
    const wanted = importance && settings.map !== "none" ? `${importance.revision} ${settings.map}` : "";
    if (wanted === this.shown) return;
    this.shown = wanted;
    if (!importance || settings.map === "none") {
      this.full.hide();
      this.miniature.hide();
      return;
    }
    this.revision = importance.revision;
    this.texture ??= makeTexture(importance);
    const points = this.points.get(settings.map) ?? choosePoints(importance, settings.map);
    this.points.set(settings.map, points);
    this.full.show(importance, settings.map, this.texture, points);
    this.miniature.show(importance, settings.map, this.texture, points);
  }

  private forget(): void {
    this.texture?.dispose();
    this.texture = null;
    for (const points of this.points.values()) points.dispose();
    this.points.clear();
    this.revision = "";
  }
}
