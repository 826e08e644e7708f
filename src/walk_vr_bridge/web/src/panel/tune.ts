// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The Tune tab: the optimiser, its weights, D, H and n, the maps' weights and the walk's timing. */

import type { Actions } from "../client/actions";
import type { Parameter, ParameterValue, State } from "../client/state";
import { optimiserSwitch } from "./optimiser";
import { parameterSlider } from "./scales";
import type { Section, Widget } from "./widgets";

interface Group {
  readonly id: string;
  readonly title: string;
  /** Label by parameter name. */
  readonly sliders: Readonly<Record<string, string>>;
}

const GROUPS: readonly Group[] = [
  {
    id: "path-weights",
    title: "Weights of the path (λ)",
    sliders: {
      "trajopt.weight_smoothness": "Smooth",
      "trajopt.weight_clearance": "Away from walls",
      "trajopt.weight_height": "At eye height",
      "trajopt.weight_length": "Short",
      "trajopt.weight_deviation": "Near the planned tour",
      "trajopt.weight_keypoints": "Through the keypoints",
    },
  },
  {
    id: "sizes",
    title: "Distance, height, points",
    sliders: {
      "trajopt.clearance_m": "D · distance to walls",
      "walker.eye_height_m": "H · eye height",
      "trajopt.points": "n · points of the path",
    },
  },
  {
    id: "timing",
    title: "Pace",
    sliders: {
      "timing.speed_mps": "Speed",
      "timing.max_turn_rate_radps": "Fastest turn",
      "timing.dwell_s": "Stay at keypoints",
      "timing.duration_s": "Duration",
    },
  },
  {
    id: "map-weights",
    title: "Weights of the importance map (λ)",
    sliders: {
      "importance.weight_obstacle": "Free of obstacles",
      "importance.weight_distance": "Distance to obstacles",
      "importance.weight_visibility": "Visibility",
    },
  },
  {
    id: "suggestions",
    title: "Suggested keypoints",
    sliders: { "keypoints.count": "Number", "keypoints.cone_radius_m": "Space between" },
  },
];

/** Sliders of values that begin at 0: what 0 means, and how far it is worth to slide. */
const FROM_ZERO: Readonly<Record<string, { zeroReads: string; reach: number }>> = {
  "trajopt.points": { zeroReads: "automatic", reach: 600 },
  "timing.duration_s": { zeroReads: "as the speed gives", reach: 900 },
  "timing.dwell_s": { zeroReads: "walk through", reach: 30 },
  "keypoints.count": { zeroReads: "as the building needs", reach: 60 },
};

export function tuneSections(state: State, actions: Actions): Section[] {
  const { parameters, session } = state;
  if (parameters.length === 0) {
    const text = "The planner has not said yet what can be tuned.";
    return [{ id: "waiting", title: "", widgets: [{ kind: "note", id: "waiting", text, tone: "plain" }] }];
  }
  const commit = (parameter: Parameter, value: ParameterValue): void => void actions.setParameter(parameter, value);
  const disabled = session.role !== "editor";
  const byName = new Map(parameters.map((parameter) => [parameter.name, parameter]));
  const sections = GROUPS.map(({ id, title, sliders }): Section => {
    const widgets = Object.entries(sliders).flatMap(([name, label]): Widget[] => {
      const parameter = byName.get(name);
      return parameter ? [{ ...parameterSlider(parameter, label, commit, FROM_ZERO[name]), disabled }] : [];
    });
    return { id, title, widgets };
  });
  return [{ id: "optimiser", title: "", widgets: optimiserWidgets(parameters, commit, disabled) }, ...sections];
}

function optimiserWidgets(
  parameters: readonly Parameter[],
  commit: (parameter: Parameter, value: ParameterValue) => void,
  disabled: boolean,
): Widget[] {
  const found = optimiserSwitch(parameters);
  if (!found) return [];
  return [
    {
      kind: "toggle",
      id: "optimiser",
      label: "Optimiser",
      hint: found.on ? "Smooth and clear of walls" : "A spline through the keypoints, walls and all",
      on: found.on,
      disabled,
      set: (on) => commit(found.parameter, found.valueFor(on)),
    },
  ];
}
