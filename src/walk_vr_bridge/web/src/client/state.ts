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
  /** How long the walker stands here; null: as the timing says. */
  readonly dwellS: number | null;
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

/** `pairing`: the server wants a code or a token first. `refused`: it will not have this client at all. */
export type ConnectionPhase = "connecting" | "pairing" | "connected" | "waiting" | "refused";

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
}

export interface Storey {
  readonly name: string;
  /** Height of its floor. */
  readonly floorZ: number;
  /** What one walks on: level rectangles, x0, y0, x1, y1, z of each. */
  readonly floor: Float32Array;
}

export interface Room {
  readonly name: string;
  /** Index of its storey. */
  readonly storey: number;
  readonly centre: Vec3;
  readonly areaM2: number;
  /** Why no tour visits it; empty where it can be reached. */
  readonly reason: string;
}

export interface ModelFile {
  readonly url: string;
  /** Names the content: another one means that the file has to be read again. */
  readonly etag: string;
  readonly triangles: number;
}

export interface BuildingState {
  readonly name: string;
  readonly hash: string;
  readonly model: ModelFile;
  readonly miniature: ModelFile;
  readonly min: Vec3;
  readonly max: Vec3;
  /** On the floor, where a visitor begins. */
  readonly start: Vec3;
  /** Lowest first. */
  readonly storeys: readonly Storey[];
  readonly rooms: readonly Room[];
  readonly walker: { readonly eyeHeightM: number; readonly heightM: number; readonly radiusM: number };
  readonly warnings: readonly string[];
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

export type ChannelName = "obstacle" | "distance" | "visibility" | "importance";

/** A byte b of a channel stands for low + (high - low) b / 255. */
export interface Channel {
  readonly name: ChannelName;
  readonly low: number;
  readonly high: number;
}

/** A grid of voxels, four bytes each in the order of the channels, x fastest, then y, then z. */
export interface ImportanceState {
  /** Lowest corner of the lowest voxel. */
  readonly origin: Vec3;
  readonly voxelM: number;
  readonly shape: readonly [number, number, number];
  readonly channels: readonly [Channel, Channel, Channel, Channel];
  readonly data: Uint8Array;
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
  readonly playing: boolean;
  /** Where it was at `atMs` of this client's clock; it goes on from there (`playbackTimeS`). */
  readonly timeS: number;
  readonly atMs: number;
  /** Times the planned speed; below 0: backwards. */
  readonly speed: number;
  readonly durationS: number;
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
  /** A new keypoint is put at the best place around where it is dropped. */
  readonly addNear: boolean;
}

export interface SelectionState {
  /** The keypoint that the panel and the view show as chosen; null: none. */
  readonly keypoint: number | null;
  /** Index of the storey shown in plan or cut; -1: all. */
  readonly storey: number;
  /** What a pointer over the view does next; `add` puts a keypoint, `lookAt` says what to look at from the chosen one. */
  readonly tool: "edit" | "add" | "lookAt";
}

/** What the sequencer offers: by how many metres another order would be shorter. */
export interface OfferState {
  readonly betterOrderSavesM: number;
}

/** What the nodes say of themselves, by node name. */
export interface NodeStatus {
  readonly node: string;
  readonly level: "ok" | "warn" | "error";
  readonly message: string;
}

export interface LoadingState {
  readonly building: string;
  readonly importance: string;
  /** The building cannot be loaded at all. */
  readonly failed: boolean;
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
  offer: OfferState;
  nodes: readonly NodeStatus[];
  /** How building and importance volume come in: a sentence while they do not. */
  loading: LoadingState;
}

export type Slice = keyof State;
