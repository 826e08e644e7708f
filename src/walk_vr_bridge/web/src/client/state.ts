// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What the page knows, slice by slice. Metres, radians, seconds; z up, frame `map`; quaternions xyzw. */

export type Vec3 = readonly [number, number, number];
export type Quat = readonly [number, number, number, number];

export interface Keypoint {
  /** Stable identity; never used again for another keypoint. */
  readonly id: number;
  /** Where the walker's eye is: the server's word, or where this client drags it at the moment. */
  readonly position: Vec3;
  /** The x axis looks ahead. */
  readonly quat: Quat;
  readonly label: string;
  readonly locked: boolean;
  readonly start: boolean;
  readonly end: boolean;
  readonly dwellS: number;
  readonly lookAt: Vec3 | null;
  /** Why the tour leaves it out, in words; empty where it does not. */
  readonly unreachable: string;
  /** Moved here by this client and not confirmed by the server yet. */
  readonly pending: boolean;
}

/** Rows of the path in fixed buffers: only the first `count` rows hold; the buffers are replaced when they grow. */
export interface PathState {
  count: number;
  /** The server's revision [ns], as text since it exceeds what a number holds; empty before the first path. */
  revision: string;
  /** 3 per row. */
  positions: Float32Array;
  /** 4 per row. */
  quats: Float32Array;
  /** Planned arrival since the start of the walk, rising. */
  timeS: Float32Array;
  speedMps: Float32Array;
  /** Height of the eye over the floor; NaN where unknown. */
  heightM: Float32Array;
  /** The body's distance to the building; NaN where unknown. Below 0: collides. */
  clearanceM: Float32Array;
  lengthM: number;
  durationS: number;
}

export interface TourState {
  count: number;
  /** 3 per row. */
  positions: Float32Array;
  revision: string;
}

export type ConnectionPhase = "connecting" | "connected" | "waiting" | "refused";

export interface ConnectionState {
  readonly phase: ConnectionPhase;
  /** One sentence for the user. */
  readonly message: string;
  /** When the next attempt starts [ms since 1970]; 0 where none is planned. */
  readonly retryAtMs: number;
  /** Edits that wait for the server's answer. */
  readonly unconfirmed: number;
}

export interface SessionState {
  /** Who this client is; part of every edit. */
  readonly clientId: string;
  readonly role: "viewer" | "editor";
  readonly others: number;
}

export interface Storey {
  readonly name: string;
  /** Height of its floor. */
  readonly floorZ: number;
}

export interface BuildingState {
  readonly name: string;
  readonly hash: string;
  /** Address of the full model, and of the simplified one; the same where there is one only. Empty: none yet. */
  readonly modelUrl: string;
  readonly miniatureUrl: string;
  readonly min: Vec3;
  readonly max: Vec3;
  readonly storeys: readonly Storey[];
  readonly eyeHeightM: number;
}

export interface Refusal {
  /** Rises; names the refusal. */
  readonly serial: number;
  readonly keypoint: number | null;
  /** Where the edit wanted to go; null where it had no place. */
  readonly place: Vec3 | null;
  readonly reason: string;
  readonly atMs: number;
}

/** A grid of voxels, x fastest, then y, then z; values 0 to 1. */
export interface ImportanceState {
  readonly origin: Vec3;
  readonly voxelM: number;
  readonly shape: readonly [number, number, number];
  readonly obstacle: Uint8Array;
  readonly distance: Uint8Array;
  readonly visibility: Uint8Array;
  readonly importance: Uint8Array;
  readonly revision: string;
}

export type ParameterValue = number | boolean | string;

export interface Parameter {
  readonly node: string;
  readonly name: string;
  readonly type: "integer" | "double" | "boolean" | "string";
  readonly description: string;
  readonly unit: string;
  readonly min: number | null;
  readonly max: number | null;
  readonly choices: readonly string[];
  readonly value: ParameterValue;
}

export interface PlaybackState {
  playing: boolean;
  timeS: number;
  /** Times the planned speed. */
  speed: number;
  /** Where the eye is, as the server plays it. */
  position: [number, number, number];
  quat: [number, number, number, number];
}

export type Surface = "building" | "transparent";
export type MapName = "none" | "obstacle" | "distance" | "visibility" | "importance";
export type PathColour = "plain" | "speed" | "clearance" | "height" | "collisions";
export type Hand = "left" | "right";

/** This client's own choices; kept in the browser. */
export interface SettingsState {
  readonly surface: Surface;
  readonly map: MapName;
  readonly pathColour: PathColour;
  /** Where playback is shown: an avatar in the miniature, or the user rides along. */
  readonly playbackPlace: "miniature" | "ride";
  readonly vignette: boolean;
  readonly fade: boolean;
  readonly snapTurn: boolean;
  readonly teleport: boolean;
  readonly hand: Hand;
}

export interface SelectionState {
  /** The keypoint that the panel and the view show as chosen; null: none. */
  readonly keypoint: number | null;
  /** Index of the storey shown in plan or cut; -1: all. */
  readonly storey: number;
}

/** What edits can be taken back or done again, as far as this client knows. */
export interface HistoryState {
  readonly betterOrderSavesM: number;
}

export interface State {
  connection: ConnectionState;
  session: SessionState;
  building: BuildingState | null;
  keypoints: readonly Keypoint[];
  path: PathState;
  tour: TourState;
  refusals: readonly Refusal[];
  importance: ImportanceState | null;
  parameters: readonly Parameter[];
  playback: PlaybackState;
  settings: SettingsState;
  selection: SelectionState;
  history: HistoryState;
}

export type Slice = keyof State;
