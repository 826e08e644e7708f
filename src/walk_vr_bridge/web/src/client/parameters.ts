// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The nodes' parameters with what they say of themselves: sliders are made from their ranges. */

import { fields, finite, list, MessageError, whole, words, type Fields } from "./check";
import type { Parameter, ParameterValue } from "./state";
import type { Store } from "./store";
import type { Wire } from "./wire";

/** Which groups each node is asked for. */
export const GROUPS: Readonly<Record<string, readonly string[]>> = {
  importance: ["importance", "keypoints", "walker"],
  sequencer: ["sequencer", "editing"],
  trajopt: ["trajopt", "timing"],
};
/** The walker measures in every node: its parameters are set in each of them. */
const WALKER_NODES = ["importance", "sequencer", "trajopt", "vr_bridge"];

const TYPES = { 1: "boolean", 2: "integer", 3: "double", 4: "string" } as const;
const VALUE_FIELDS = {
  boolean: "bool_value",
  integer: "integer_value",
  double: "double_value",
  string: "string_value",
};
const TYPE_NUMBERS = { boolean: 1, integer: 2, double: 3, string: 4 };
const UNIT = / \[([^\]]+)\]$/;
const CHOICES = / \(one of: ([^)]+)\)$/;
/** Beyond this a range is no range that a slider could show. */
const OPEN = 9e18;

type Caller = Pick<Wire, "call">;

/** Reads a node's parameters. @throws WireError, MessageError. */
export async function readParameters(wire: Caller, namespace: string, node: string): Promise<Parameter[]> {
  const service = (name: string): string => `${namespace}/${node}/${name}`;
  const prefixes = GROUPS[node] ?? [];
  const listed = fields(await wire.call(service("list_parameters"), { prefixes, depth: 0 }), "list_parameters");
  const names = list(fields(listed.result, "result").names, "names").map((name) => words(name, "name"));
  const described = await wire.call(service("describe_parameters"), { names });
  const got = await wire.call(service("get_parameters"), { names });
  const descriptors = list(fields(described, "answer").descriptors, "descriptors");
  const values = list(fields(got, "answer").values, "values");
  if (descriptors.length !== names.length || values.length !== names.length) {
    throw new MessageError(`${node} describes ${descriptors.length} of ${names.length} parameters`);
  }
  return names.flatMap((name, index) => parameterOf(node, name, descriptors[index], values[index]) ?? []);
}

/** Returns one parameter, null where it is of a kind that no panel shows (lists). */
function parameterOf(node: string, name: string, descriptor: unknown, value: unknown): Parameter | null {
  const said = fields(descriptor, name);
  const held = fields(value, name);
  const type = TYPES[whole(held.type, name) as keyof typeof TYPES];
  if (!type) return null;
  const full = words(said.description, name);
  const withoutChoices = full.replace(CHOICES, "");
  return {
    node,
    name,
    type,
    description: withoutChoices.replace(UNIT, ""),
    unit: UNIT.exec(withoutChoices)?.[1] ?? "",
    choices: CHOICES.exec(full)?.[1]?.split(", ") ?? [],
    ...rangeOf(said),
    value: held[VALUE_FIELDS[type]] as ParameterValue,
  };
}

function rangeOf(descriptor: Fields): { min: number | null; max: number | null } {
  const ranges = [
    ...list(descriptor.floating_point_range ?? [], "range"),
    ...list(descriptor.integer_range ?? [], "range"),
  ];
  if (ranges.length === 0) return { min: null, max: null };
  const { from_value: from, to_value: to } = fields(ranges[0], "range");
  return { min: bound(from), max: bound(to) };
}

function bound(value: unknown): number | null {
  return value === null || Math.abs(finite(value, "bound")) > OPEN ? null : finite(value, "bound");
}

/** Sets a parameter, in every node that it concerns. Returns why it was refused, "" where it was not. */
export async function writeParameter(
  wire: Caller,
  namespace: string,
  parameter: Parameter,
  value: ParameterValue,
): Promise<string> {
  const nodes = parameter.name.startsWith("walker.") ? WALKER_NODES : [parameter.node];
  const held = { type: TYPE_NUMBERS[parameter.type], [VALUE_FIELDS[parameter.type]]: value };
  const args = { parameters: [{ name: parameter.name, value: held }] };
  for (const node of nodes) {
    const answer = await wire.call(`${namespace}/${node}/set_parameters_atomically`, args);
    const { successful, reason } = fields(fields(answer, "answer").result, "result");
    if (successful !== true) return words(reason, "reason") || `${node} refused ${parameter.name}`;
  }
  return "";
}

/** Puts parameters of one node in the place of those known before. */
export function keepParameters(store: Store, node: string, news: readonly Parameter[]): void {
  store.set("parameters", [...store.state.parameters.filter((one) => one.node !== node), ...news]);
}

/** Shows a parameter's value before, or without, asking for it again. */
export function showValue(store: Store, name: string, value: ParameterValue): void {
  store.set(
    "parameters",
    store.state.parameters.map((one) => (one.name === name ? { ...one, value } : one)),
  );
}
