// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { type Box3, BufferGeometry, type Data3DTexture, Plane, Vector3 } from "three";
import type { ChannelName } from "../client/state";
import type { Store } from "../client/store";
import { makeCarpet, OVER_FLOOR_M } from "./carpet";
import { type Clip, CUT_OVER_FLOOR_M } from "./clipping";
import type { MapView } from "./mapview";
import { choosePoints, makeTexture, rangeIndoors } from "./volume";

/** The map that the user chose, in the full scale and in the miniature; texture and points are made once a revision. */
export class Maps {
  private texture: Data3DTexture | null = null;
  private revision = "";
  private readonly points = new Map<ChannelName, BufferGeometry>();
  private shown = "";
  private floors = new BufferGeometry();
  private readonly level = new Plane(new Vector3(0, 0, -1), 0);
  private readonly middle = new Vector3();
  private readonly size = new Vector3();

  constructor(
    private readonly store: Store,
    private readonly full: MapView,
    private readonly miniature: MapView,
  ) {
    store.subscribe("building", () => this.lay());
    store.subscribe("importance", () => this.choose());
    store.subscribe("settings", () => this.choose());
    this.lay();
  }

  /**
   * Once a frame. Where the miniature is cut along a storey, and at full scale, a map lies on the floors, so that keypoints and path
   * stand on it instead of below it; a free cut carries the map itself. Obstacles are hardly where one walks: they are shown as a
   * slice over the whole storey.
   *
   * @param floorZ the floor that the viewer stands on [m].
   */
  update(clip: Clip, bounds: Box3, floorZ: number, inHand: boolean): void {
    if (!this.shown) return;
    bounds.getCenter(this.middle);
    const width = 1.5 * bounds.getSize(this.size).length();
    const solid = this.store.state.settings.map === "obstacle";
    const storey = clip.active ? this.store.state.building?.storeys[clip.storey] : undefined;
    this.level.constant = (storey?.floorZ ?? 0) + OVER_FLOOR_M;
    const cut = storey ? (solid ? this.level : null) : clip.active ? clip.plane : null;
    this.miniature.setSlice(cut, this.middle, width, storey ? clip.plane.constant - this.level.constant : 0);
    this.miniature.showCarpet(!solid && storey !== undefined);
    this.miniature.showPoints(!clip.active);
    this.miniature.setPointSize(inHand ? 4 : 160);
    this.level.constant = floorZ + OVER_FLOOR_M;
    this.full.setSlice(solid ? this.level : null, this.middle, width, CUT_OVER_FLOOR_M);
    this.full.showCarpet(!solid);
    // In a room that one stands in, points in the air are in the way; of obstacles they lie on what is there anyway.
    this.full.showPoints(solid);
    this.full.setPointSize(24);
  }

  /** Another building has other floors. */
  private lay(): void {
    this.floors.dispose();
    this.floors = makeCarpet(this.store.state.building?.storeys ?? []);
    this.shown = "";
    this.choose();
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
    const range = rangeIndoors(importance, settings.map, this.store.state.building?.storeys ?? []);
    this.full.show(importance, settings.map, this.texture, points, this.floors, range);
    this.miniature.show(importance, settings.map, this.texture, points, this.floors, range);
  }

  private forget(): void {
    this.texture?.dispose();
    this.texture = null;
    for (const points of this.points.values()) points.dispose();
    this.points.clear();
    this.revision = "";
  }
}
