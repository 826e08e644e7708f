// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import type { Parameter, ParameterValue } from "../client/state";

export interface OptimiserSwitch {
  readonly parameter: Parameter;
  readonly on: boolean;
  valueFor(on: boolean): ParameterValue;
}

/** How the planner is told to optimise or not; null while it has not said that it can. */
export function optimiserSwitch(parameters: readonly Parameter[]): OptimiserSwitch | null {
  const parameter = parameters.find(({ name }) => name === "trajopt.optimise");
  if (!parameter) return null;
  return { parameter, on: parameter.value === true, valueFor: (on) => on };
}
