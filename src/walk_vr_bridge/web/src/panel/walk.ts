// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The Play tab: playback and comfort. "Walk" is the view in which one walks by oneself. */

import type { Actions } from "../client/actions";
import type { Hand, SettingsState, State } from "../client/state";
import { button } from "./buttons";
import type { Section, Slider, Toggle, Widget } from "./widgets";

const SPEEDS = ["0.5", "1", "2", "4"];

export function walkSections(state: State, actions: Actions, timeS: number): Section[] {
  return [
    { id: "playback", title: "Walkthrough", widgets: playbackWidgets(state, actions, timeS) },
    { id: "place", title: "", widgets: [placeChoice(state, actions)] },
    { id: "comfort", title: "Comfort in the headset", widgets: comfortWidgets(state.settings, actions) },
    { id: "hand", title: "Main hand", widgets: [handChoice(state.settings, actions)] },
  ];
}

function playbackWidgets(state: State, actions: Actions, timeS: number): Widget[] {
  const { playback, path, session } = state;
  const disabled = session.role !== "editor" || path.count === 0;
  const toggle = playback.playing
    ? button("pause", "Pause", () => void actions.pause(), { icon: "pause", disabled, tone: "primary" })
    : button("play", "Play", () => void actions.play(), { icon: "play", disabled, tone: "primary" });
  const stop = button("stop", "Stop", () => void actions.stop(), { icon: "stop", disabled });
  return [
    { kind: "row", id: "playback", buttons: [toggle, stop] },
    timeSlider(state, actions, timeS, disabled),
    {
      kind: "choice",
      id: "speed",
      label: "Speed",
      options: SPEEDS.map((value) => ({ value, label: `${value} ×` })),
      value: String(playback.speed),
      disabled,
      choose: (value) => actions.speed(Number(value)),
    },
  ];
}

export function timeSlider({ playback, path }: State, actions: Actions, timeS: number, disabled: boolean): Slider {
  const durationS = playback.durationS || path.durationS;
  return {
    kind: "slider",
    id: "time",
    label: "Time",
    position: durationS > 0 ? Math.min(1, timeS / durationS) : 0,
    step: durationS > 0 ? 1 / durationS : 1,
    disabled,
    text: (position) => `${clock(position * durationS)} of ${clock(durationS)}`,
    input: (position) => actions.seek(position * durationS),
    commit: (position) => actions.seek(position * durationS),
  };
}

/** Minutes and seconds. */
export function clock(seconds: number): string {
  const whole = Math.max(0, Math.round(seconds));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

function placeChoice({ settings }: State, actions: Actions): Widget {
  return {
    kind: "choice",
    id: "place",
    label: "Watch it",
    options: [
      { value: "miniature", label: "From outside" },
      { value: "ride", label: "Walk along" },
    ],
    value: settings.playbackPlace,
    choose: (value) => actions.set({ playbackPlace: value as SettingsState["playbackPlace"] }),
  };
}

function comfortWidgets(settings: SettingsState, actions: Actions): Widget[] {
  const toggle = (name: "vignette" | "fade" | "snapTurn" | "teleport", label: string, hint: string): Toggle => ({
    kind: "toggle",
    id: name,
    label,
    hint,
    on: settings[name],
    set: (on) => actions.set({ [name]: on }),
  });
  return [
    toggle("vignette", "Narrow the view while moving", "Darkens the rim with speed"),
    toggle("fade", "Fade at jumps", "Goes dark for a moment"),
    toggle("snapTurn", "Turn in steps", "Off: turn smoothly"),
    toggle("teleport", "Move by pointing", "Off: walk with the stick"),
  ];
}

function handChoice(settings: SettingsState, actions: Actions): Widget {
  return {
    kind: "choice",
    id: "hand",
    label: "Main hand",
    options: [
      { value: "left", label: "Left" },
      { value: "right", label: "Right" },
    ],
    value: settings.hand,
    choose: (value) => actions.set({ hand: value as Hand }),
  };
}
