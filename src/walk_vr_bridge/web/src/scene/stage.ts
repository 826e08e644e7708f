// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Box3, Group, type Plane, Vector3 } from "three";
import { playbackTimeS, type PathPoint, pathPoint, samplePath } from "../client/playback";
import type { Keypoint } from "../client/state";
import type { Store } from "../client/store";
import { sentence } from "../client/words";
import { headingOf, makeWorld } from "./axes";
import { Bin } from "./bin";
import { BuildingCopy } from "./copy";
import { Maps } from "./maps";
import { Miniature } from "./miniature";
import { loadModels, type Models } from "./models";
import { Note } from "./note";
import { Overlay } from "./overlay";
import { paintPath } from "./pathview";
import { DIM, type Showing } from "./pins";
import { PathTube } from "./tube";
import type { View } from "./view";
import { fillsView } from "./walker";

/**
 * How the building is shown. `room`: full scale and miniature at once, as in the headset. `model`: only the miniature, at full size
 * where it stands, as the desktop's orbit and plan want it. `inside`: full scale only, as the desktop's walk wants it.
 */
export type StageMode = "room" | "model" | "inside";

const EYE_M = 1.6;
/** How far under the eye things are drawn [m]: below a storey's cut in the miniature, below the chin at full scale. */
const MINIATURE_BELOW_M = 0.6;
const FULL_BELOW_M = 0.35;
const FULL_PATH_BELOW_M = 1.35;
const REFUSAL_S = 6;
/** A sentence is written so much larger than a keypoint's name: it has to be read through. */
export const SENTENCE_TIMES = 2.2;
/** How solid keypoints are that are seen through a roof. */
const HIDDEN_BY_ROOF = 0.7;
/** A keypoint in the miniature, in the room [m]. */
const PIN_IN_HAND_M = 0.0075;

/** Everything one sees of the building, kept at what the store says. */
export class Stage {
  readonly world: Group = makeWorld();
  readonly full = new BuildingCopy([]);
  readonly miniature: Miniature;
  readonly bin = new Bin();
  readonly tube = new PathTube();
  readonly inFull: Overlay;
  readonly inMiniature: Overlay;
  readonly refusalNote = new Note("rgba(176, 32, 40, 0.95)");
  readonly nameNote = new Note("rgba(24, 34, 46, 0.9)", 0.22);
  models: Models | null = null;
  /** The keypoint a hand or pointer is at. */
  hover: number | null = null;
  /** Where the playback stands on the path, if there is one. */
  readonly player: PathPoint = pathPoint();
  mode: StageMode = "model";
  /** Called when another building has been put up. */
  onBuilding: (() => void) | null = null;
  readonly overlays: readonly Overlay[];
  private readonly maps: Maps;
  private readonly fullGroup = new Group();
  private shown = "";
  private drawn = false;
  private refusals = 0;
  private wasCut = false;

  constructor(
    readonly view: View,
    readonly store: Store,
  ) {
    view.scene.add(this.world, this.bin.group, this.refusalNote.mesh, this.nameNote.mesh);
    this.fullGroup.add(this.full.group);
    this.world.add(this.fullGroup);
    this.miniature = new Miniature(this.world);
    const none: Plane[] = [];
    this.inFull = new Overlay("full", this.fullGroup, this.tube, [none, none], FULL_BELOW_M, FULL_PATH_BELOW_M);
    const { group, planes, pathPlanes } = this.miniature;
    const cuts: [Plane[], Plane[]] = [planes, pathPlanes];
    this.inMiniature = new Overlay("miniature", group, this.tube, cuts, MINIATURE_BELOW_M, MINIATURE_BELOW_M);
    this.overlays = [this.inMiniature, this.inFull];
    this.maps = new Maps(store, this.inFull.map, this.inMiniature.map);
    this.setMode("model");
    this.listen();
    view.onFrame((seconds) => this.update(seconds));
  }

  setMode(mode: StageMode): void {
    this.mode = mode;
    this.fullGroup.visible = mode !== "model";
    this.miniature.group.visible = mode !== "inside";
    this.miniature.showBase(mode === "room");
    this.bin.group.visible = mode === "room";
    if (mode === "model") this.miniature.placeTrue();
    this.wearModels();
    this.restyle();
  }

  get eyeHeightM(): number {
    return this.store.state.building?.walker.eyeHeightM ?? EYE_M;
  }

  /** Index of the storey whose floor is under a height of the map [m]. */
  storeyAt(z: number): number {
    const storeys = this.store.state.building?.storeys ?? [];
    let found = 0;
    for (let i = 0; i < storeys.length; i++) if (storeys[i].floorZ <= z + 0.3) found = i;
    return found;
  }

  /** Where the user has moved something last, if both are there. */
  touched: Overlay | null = null;

  /** Where a refusal is told: where it happened. */
  overlayInView(): Overlay {
    if (this.mode === "room" && this.touched) return this.touched;
    return this.mode === "inside" ? this.inFull : this.inMiniature;
  }

  private listen(): void {
    const { store } = this;
    store.subscribe("building", () => void this.putUp());
    store.subscribe("path", () => this.takePath());
    store.subscribe("settings", () => this.restyle());
    store.subscribe("selection", () => this.cutToSelection());
    store.subscribe("refusals", () => this.showRefusal());
    if (store.state.building) void this.putUp();
    if (store.state.path.count) this.takePath();
  }

  private async putUp(): Promise<void> {
    const { building } = this.store.state;
    const name = building ? building.model.etag + building.miniature.etag : "";
    if (!building || name === this.shown) return;
    this.shown = name;
    try {
      const models = await loadModels(building);
      if (this.shown !== name) return;
      this.models = models;
    } catch (error) {
      this.shown = "";
      this.store.patch("loading", { building: `The model cannot be shown: ${String(error)}`, failed: true });
      return;
    }
    const bounds = this.models.full.bounds;
    this.wearModels();
    this.miniature.fit(bounds);
    this.miniature.clip.reset(bounds.min.z, bounds.max.z, building.storeys);
    this.view.ground.position.y = bounds.min.z - 0.03;
    this.view.ground.position.x = (bounds.min.x + bounds.max.x) / 2;
    this.view.ground.position.z = -(bounds.min.y + bounds.max.y) / 2;
    this.cutToSelection();
    this.restyle();
    this.onBuilding?.();
  }

  /** On the desktop the model is looked at from near: it wears the full geometry. */
  private wearModels(): void {
    if (!this.models) return;
    this.full.setModel(this.models.full);
    this.miniature.copy.setModel(this.mode === "room" ? this.models.miniature : this.models.full);
  }

  get bounds(): Box3 {
    return this.models?.full.bounds ?? EMPTY;
  }

  private takePath(): void {
    const { path, settings } = this.store.state;
    this.tube.setPath(path.positions, path.count);
    paintPath(this.tube, path, settings.pathColour);
  }

  private restyle(): void {
    const { path, settings } = this.store.state;
    paintPath(this.tube, path, settings.pathColour);
    const thin = settings.surface === "transparent";
    const { clip } = this.miniature;
    this.wasCut = clip.active;
    this.full.setThin(thin);
    this.miniature.copy.setThin(thin || (settings.map !== "none" && !clip.active));
    this.miniature.copy.showCaps(clip.active && !thin);
    this.drawn = false;
  }

  private cutToSelection(): void {
    const { storey } = this.store.state.selection;
    const { clip } = this.miniature;
    if (storey !== clip.storey || (storey < 0 && clip.active)) clip.cutStorey(storey);
    this.restyle();
  }

  private showRefusal(): void {
    const last = this.store.state.refusals.at(-1);
    if (!last || last.serial <= this.refusals) return;
    this.refusals = last.serial;
    const at = last.place ?? this.store.state.keypoints.find(({ id }) => id === last.keypoint)?.position;
    if (!at) return;
    const overlay = this.overlayInView();
    overlay.place.shown(at, AT);
    AT.y += overlay.size * overlay.place.scale * 4;
    this.refusalNote.show(sentence(last.reason), AT, REFUSAL_S, SENTENCE_TIMES);
  }

  private update(seconds: number): void {
    const { view, miniature } = this;
    if (miniature.clip.active !== this.wasCut) this.restyle();
    miniature.update(this.eyeHeightM - MINIATURE_BELOW_M);
    this.setSizes();
    this.full.lookFrom(view.eye);
    miniature.copy.lookFrom(view.eye);
    this.drawKeypoints();
    this.maps.update(miniature.clip, this.bounds, this.viewerFloor(), this.mode === "room");
    this.walk();
    this.refusalNote.update(seconds, view.camera, view.eye);
    this.nameNote.update(seconds, view.camera, view.eye);
  }

  private setSizes(): void {
    this.inFull.setSize(0.11);
    const { scale } = this.inMiniature.place;
    if (this.mode === "room") this.inMiniature.setSize(Math.min(0.6, Math.max(0.08, PIN_IN_HAND_M / scale)));
    else this.inMiniature.setSize(this.modelPinM);
  }

  /** Radius of a keypoint in the mode `model`: whoever moves the camera keeps it in proportion [m]. */
  modelPinM = 0.22;

  private viewerFloor(): number {
    return this.store.state.building?.storeys[this.storeyAt(this.view.rig.position.y)]?.floorZ ?? this.view.rig.position.y;
  }

  private drawKeypoints(): void {
    const { store, miniature, hover } = this;
    const { keypoints, selection, settings } = store.state;
    const floor = this.storeyAt(this.view.rig.position.y);
    const now = STATE;
    now[0] = store.version("keypoints");
    now[1] = miniature.clip.version;
    now[2] = hover ?? -1;
    now[3] = selection.keypoint ?? -1;
    now[4] = floor;
    let same = this.drawn;
    for (let i = 0; i < now.length; i++) same = same && now[i] === DRAWN[i];
    if (same) return;
    this.drawn = true;
    DRAWN.set(now);
    const thin = settings.surface === "transparent" || !this.models;
    // Under a roof there are no others; under a cut they are those of the storeys below.
    this.inMiniature.pins.setDimmed(miniature.clip.active ? DIM : HIDDEN_BY_ROOF);
    this.inMiniature.update(keypoints, (keypoint) => this.showingInMiniature(keypoint, thin), hover, selection.keypoint);
    this.inFull.update(keypoints, (keypoint) => this.showingInFull(keypoint, floor), hover, selection.keypoint);
  }

  private showingInMiniature(keypoint: Keypoint, thin: boolean): Showing {
    const { clip } = this.miniature;
    const [x, y, z] = keypoint.position;
    const floorZ = z - this.eyeHeightM;
    if (!clip.active) return thin ? "plain" : "dimmed";
    if (!clip.keepsOnFloor(x, y, floorZ)) return "hidden";
    return this.storeyAt(floorZ) < clip.openStorey && !thin ? "dimmed" : "plain";
  }

  private showingInFull(keypoint: Keypoint, floor: number): Showing {
    return this.storeyAt(keypoint.position[2] - this.eyeHeightM) < floor ? "dimmed" : "plain";
  }

  private walk(): void {
    const { path, playback } = this.store.state;
    const timeS = playbackTimeS(playback, Date.now());
    const shown = (playback.playing || playback.timeS > 0) && samplePath(path, timeS, this.player);
    for (let i = 0; i < this.overlays.length; i++) {
      const overlay = this.overlays[i];
      overlay.walker.visible = shown;
      if (!shown) continue;
      const q = this.player.quat;
      overlay.walk(this.player.position, headingOf(q[0], q[1], q[2], q[3]), this.eyeHeightM);
    }
    // Also when the ride pauses, the user stands where the figure would.
    if (this.riding || fillsView(this.player.position, this.view.eye)) this.inFull.walker.visible = false;
  }

  /** True while the user rides the tour: the figure would stand in the user's head. */
  riding = false;
}

const EMPTY = new Box3(new Vector3(0, 0, 0), new Vector3(1, 1, 1));
const AT = new Vector3();
const STATE = new Float64Array(5);
const DRAWN = new Float64Array(5);
