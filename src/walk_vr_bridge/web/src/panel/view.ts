// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The View tab: how the building is shown, which map is laid into it, and what the path is coloured by. */

import type { Actions } from "../client/actions";
import type { ChannelName, ImportanceState, MapName, PathColour, State, Storey, Surface } from "../client/state";
import { rangeIndoors } from "../scene/volume";
import type { Legend, Section, Widget } from "./widgets";

const SURFACES = [
  { value: "building", label: "Solid" },
  { value: "transparent", label: "Transparent" },
];
const MAPS = [
  { value: "none", label: "None" },
  { value: "obstacle", label: "Obstacle" },
  { value: "distance", label: "Distance" },
  { value: "visibility", label: "Visibility" },
  { value: "importance", label: "Importance" },
];
/** What the numbers of a map say; see docs/importance.md. */
const MEANINGS: Readonly<Record<ChannelName, string>> = {
  obstacle: "Red: something stands there.",
  distance: "0: at a wall or a thing; 1: as far from them as counts.",
  visibility: "How much of all free space one sees from there: 0 none, 1 all.",
  importance: "How much there is to see: the weighted sum of the other maps.",
};
const COLOURS = [
  { value: "plain", label: "Plain" },
  { value: "speed", label: "Speed" },
  { value: "clearance", label: "Clearance" },
  { value: "height", label: "Height" },
  { value: "collisions", label: "Collisions" },
];

/** Clearance is painted over this range [m]; see the scene's path view. */
const CLEARANCE_RANGE = ["0 m: touches", "0.6 m and more"] as const;

export function viewSections(state: State, actions: Actions): Section[] {
  const { settings } = state;
  return [
    {
      id: "surface",
      title: "Building",
      widgets: [
        {
          kind: "choice",
          id: "surface",
          label: "Building",
          options: SURFACES,
          value: settings.surface,
          choose: (value) => actions.set({ surface: value as Surface }),
        },
        ...storeyChoice(state, actions),
      ],
    },
    { id: "map", title: "Map in the building", widgets: mapWidgets(state, actions) },
    { id: "path", title: "Path coloured by", widgets: pathWidgets(state, actions) },
    ...(state.building?.warnings.length ? [{ id: "file", title: "About the file", widgets: fileWidgets(state) }] : []),
  ];
}

/** What the file left open, and what was made of it. */
function fileWidgets({ building }: State): Widget[] {
  return (building?.warnings ?? []).map((text, index) => ({ kind: "note", id: `warning:${index}`, text, tone: "plain" }));
}

function storeyChoice({ building, selection }: State, actions: Actions): Widget[] {
  if (!building || building.storeys.length < 2) return [];
  const storeys = building.storeys.map(({ name }, index) => ({ value: String(index), label: name }));
  return [
    {
      kind: "choice",
      id: "storey",
      label: "Storey",
      options: [{ value: "-1", label: "All" }, ...storeys.reverse()],
      value: String(selection.storey),
      choose: (value) => actions.showStorey(Number(value)),
    },
  ];
}

function mapWidgets({ settings, importance, loading, building }: State, actions: Actions): Widget[] {
  const widgets: Widget[] = [
    {
      kind: "choice",
      id: "map",
      label: "Map",
      options: MAPS,
      value: settings.map,
      choose: (value) => actions.set({ map: value as MapName }),
    },
  ];
  if (settings.map === "none") return widgets;
  if (!importance) {
    const text = loading.importance || "The maps are being computed …";
    return [...widgets, { kind: "note", id: "no-map", text, tone: "plain" }];
  }
  if (settings.map !== "obstacle") widgets.push(mapLegend(importance, settings.map, building?.storeys ?? []));
  return [...widgets, { kind: "note", id: "map-meaning", text: MEANINGS[settings.map], tone: "plain" }];
}

/** What the ends of the colours mean, by map and channel: finding it looks through the whole map. */
const legends = new WeakMap<ImportanceState, Map<ChannelName, Legend>>();

function mapLegend(importance: ImportanceState, channel: ChannelName, storeys: readonly Storey[]): Legend {
  const known = legends.get(importance) ?? new Map<ChannelName, Legend>();
  legends.set(importance, known);
  const before = known.get(channel);
  if (before) return before;
  const { low, high } = importance.channels.find(({ name }) => name === channel) ?? { low: 0, high: 1 };
  const [from, to] = rangeIndoors(importance, channel, storeys);
  const read = (share: number): string => (low + (high - low) * share).toFixed(2);
  const legend: Legend = { kind: "legend", id: "map-legend", low: read(from), high: read(to) };
  known.set(channel, legend);
  return legend;
}

function pathWidgets(state: State, actions: Actions): Widget[] {
  const { settings } = state;
  const widgets: Widget[] = [
    {
      kind: "choice",
      id: "path-colour",
      label: "Path coloured by",
      options: COLOURS,
      value: settings.pathColour,
      choose: (value) => actions.set({ pathColour: value as PathColour }),
    },
  ];
  return [...widgets, ...pathLegend(state)];
}

function pathLegend({ settings, path }: State): Widget[] {
  const by = settings.pathColour;
  if (by === "plain" || path.count === 0) return [];
  const values = by === "speed" ? path.speedMps : by === "height" ? path.heightM : path.clearanceM;
  const [low, high, unknown] = spread(values, path.count);
  // Heights are unknown for good where there is no floor below; clearance is known everywhere once it has been measured.
  const left = by === "speed" ? 0 : spread(path.clearanceM, path.count)[2];
  if (left > 0 || unknown === path.count) {
    const part = Math.floor((100 * (path.count - left)) / path.count);
    return [{ kind: "note", id: "path-unknown", text: `Being measured along the path: ${part} %`, tone: "plain" }];
  }
  if (by === "collisions") return [collisionNote(values, path.count)];
  if (by === "clearance") {
    return [
      { kind: "legend", id: "path-legend", low: CLEARANCE_RANGE[0], high: CLEARANCE_RANGE[1] },
      { kind: "note", id: "least", text: `Narrowest place: ${low.toFixed(2)} m`, tone: "plain" },
    ];
  }
  const unit = by === "speed" ? "m/s" : "m";
  const read = (value: number): string => `${value.toFixed(2)} ${unit}`;
  return [{ kind: "legend", id: "path-legend", low: read(low), high: read(high) }];
}

function spread(values: Float32Array, count: number): [number, number, number] {
  let [low, high, unknown] = [Infinity, -Infinity, 0];
  for (let row = 0; row < count; row++) {
    const value = values[row]!;
    if (Number.isNaN(value)) unknown++;
    low = Math.min(low, Number.isNaN(value) ? low : value);
    high = Math.max(high, Number.isNaN(value) ? high : value);
  }
  return [low, high, unknown];
}

function collisionNote(clearanceM: Float32Array, count: number): Widget {
  let hits = 0;
  for (let row = 0; row < count; row++) if (clearanceM[row]! < 0) hits++;
  if (hits === 0) return { kind: "note", id: "free", text: "The walker touches nothing.", tone: "good" };
  return {
    kind: "note",
    id: "hits",
    text: `The walker touches the building at ${hits} of ${count} places.`,
    tone: "warn",
  };
}
