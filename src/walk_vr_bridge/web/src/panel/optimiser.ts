// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import type { Parameter, ParameterValue } from "../client/state";

export interface OptimiserSwitch {
  readonly parameter: Parameter;
  readonly on: boolean;
  valueFor(on: boolean): ParameterValue;
}

/** How the path comes from the tour: optimised, or, with the optimiser off, a spline through the keypoints. */
const PATH_BY = "trajopt.mode";
const OPTIMISED = "optimised";
const SPLINE = "catmull_rom";

/** How the planner is told to optimise or not; null while it has not said that it can. */
export function optimiserSwitch(parameters: readonly Parameter[]): OptimiserSwitch | null {
  const parameter = parameters.find(({ name }) => name === PATH_BY);
  if (!parameter) return null;
  const valueFor = (on: boolean): ParameterValue => (on ? OPTIMISED : SPLINE);
  return { parameter, on: parameter.value === OPTIMISED, valueFor };
}
