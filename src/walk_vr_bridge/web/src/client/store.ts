// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The page's state with listeners per slice; telling them costs no allocation. */

import type {
  LoadingState,
  OfferState,
  PathState,
  SelectionState,
  SettingsState,
  Slice,
  State,
  TourState,
} from "./state";

export type Listener = () => void;

export const DEFAULT_SETTINGS: SettingsState = {
  surface: "building",
  map: "none",
  pathColour: "plain",
  playbackPlace: "miniature",
  vignette: true,
  fade: true,
  snapTurn: true,
  teleport: true,
  hand: "right",
  addNear: false,
};

const NO_SELECTION: SelectionState = { keypoint: null, storey: -1, tool: "edit" };
const NO_OFFER: OfferState = { betterOrderSavesM: 0 };
const LOADING: LoadingState = { building: "The building is loading …", importance: "", failed: false };

export function emptyPath(): PathState {
  return {
    count: 0,
    revision: "",
    positions: new Float32Array(0),
    quats: new Float32Array(0),
    timeS: new Float32Array(0),
    speedMps: new Float32Array(0),
    heightM: new Float32Array(0),
    clearanceM: new Float32Array(0),
    lengthM: 0,
    durationS: 0,
  };
}

function emptyTour(): TourState {
  return { count: 0, positions: new Float32Array(0), revision: "" };
}

export function initialState(clientId: string): State {
  return {
    connection: { phase: "connecting", message: "Connecting …", retryAtMs: 0, unconfirmed: 0 },
    session: { clientId, role: "viewer" },
    building: null,
    keypoints: [],
    path: emptyPath(),
    tour: emptyTour(),
    refusals: [],
    importance: null,
    parameters: [],
    playback: { playing: false, timeS: 0, atMs: 0, speed: 1, durationS: 0 },
    settings: DEFAULT_SETTINGS,
    selection: NO_SELECTION,
    offer: NO_OFFER,
    nodes: [],
    loading: LOADING,
  };
}

export class Store {
  readonly state: State;
  private readonly listeners = new Map<Slice, Listener[]>();
  private readonly versions: Record<Slice, number>;

  constructor(state: State) {
    this.state = state;
    this.versions = Object.fromEntries(Object.keys(state).map((slice) => [slice, 0])) as Record<Slice, number>;
  }

  /** Calls the listener after each change of the slice; returns what ends that. */
  subscribe(slice: Slice, listener: Listener): () => void {
    // Arrays are replaced, never changed, so that a listener may come or go while others are being told.
    this.listeners.set(slice, [...(this.listeners.get(slice) ?? []), listener]);
    return () => {
      this.listeners.set(slice, this.listeners.get(slice)?.filter((other) => other !== listener) ?? []);
    };
  }

  /** How often the slice has changed: for code that looks once a frame instead of listening. */
  version(slice: Slice): number {
    return this.versions[slice];
  }

  /** Replaces a slice and tells its listeners. */
  set<S extends Slice>(slice: S, value: State[S]): void {
    this.state[slice] = value;
    this.touch(slice);
  }

  /** Changes some fields of a slice that is a record. */
  patch<S extends "connection" | "session" | "settings" | "selection" | "offer" | "loading">(
    slice: S,
    fields: Partial<State[S]>,
  ): void {
    this.set(slice, { ...this.state[slice], ...fields });
  }

  /** Tells the listeners of a slice that was changed in place. */
  touch(slice: Slice): void {
    this.versions[slice] += 1;
    const listeners = this.listeners.get(slice);
    if (!listeners) return;
    for (let index = 0; index < listeners.length; index++) listeners[index]?.();
  }
}
