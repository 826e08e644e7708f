// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { readParameters, writeParameter } from "../../src/client/parameters";

const FLOATS = [{ from_value: 0, to_value: null, step: 0 }];
const ANSWERS: Record<string, unknown> = {
  list_parameters: {
    result: { names: ["trajopt.clearance_m", "trajopt.solver", "trajopt.points", "x.list"], prefixes: [] },
  },
  describe_parameters: {
    descriptors: [
      { name: "a", type: 3, description: "wished distance D [m]", floating_point_range: FLOATS, integer_range: [] },
      { name: "b", type: 4, description: "how (one of: lbfgs, other)", floating_point_range: [], integer_range: [] },
      { name: "c", type: 2, description: "points", integer_range: [{ from_value: 0, to_value: 9.3e18, step: 0 }] },
      { name: "d", type: 9, description: "" },
    ],
  },
  get_parameters: {
    values: [
      { type: 3, double_value: 0.42 },
      { type: 4, string_value: "lbfgs" },
      { type: 2, integer_value: 100 },
      { type: 9 },
    ],
  },
};

function wireOf(answers: Record<string, unknown>, log: [string, unknown][] = []) {
  return {
    call: (service: string, args: unknown = {}): Promise<unknown> => {
      log.push([service, args]);
      return Promise.resolve(answers[service.split("/").at(-1)!]);
    },
  };
}

describe("parameters", () => {
  it("are read with range, unit and choices", async () => {
    const parameters = await readParameters(wireOf(ANSWERS), "/walk", "trajopt");
    expect(parameters).toEqual([
      expect.objectContaining({
        name: "trajopt.clearance_m",
        description: "wished distance D",
        unit: "m",
        min: 0,
        max: null,
        value: 0.42,
      }),
      expect.objectContaining({
        name: "trajopt.solver",
        description: "how",
        choices: ["lbfgs", "other"],
        value: "lbfgs",
      }),
      expect.objectContaining({ name: "trajopt.points", type: "integer", min: 0, max: null, value: 100 }),
    ]);
  });

  it("of the walker are set in every node, others in their own, and a refusal says why", async () => {
    const log: [string, unknown][] = [];
    const taken = { set_parameters_atomically: { result: { successful: true, reason: "" } } };
    const eye = {
      node: "importance",
      name: "walker.eye_height_m",
      type: "double",
      description: "",
      unit: "m",
      min: 0,
      max: 3,
      choices: [],
      value: 1.6,
    } as const;
    expect(await writeParameter(wireOf(taken, log), "/walk", eye, 1.5)).toBe("");
    expect(log.map(([service]) => service.split("/")[2])).toEqual(["importance", "sequencer", "trajopt", "vr_bridge"]);
    expect(log[0]![1]).toEqual({
      parameters: [{ name: "walker.eye_height_m", value: { type: 3, double_value: 1.5 } }],
    });
    const refused = { set_parameters_atomically: { result: { successful: false, reason: "out of range" } } };
    const d = { ...eye, node: "trajopt", name: "trajopt.clearance_m" };
    expect(await writeParameter(wireOf(refused, log), "/walk", d, 99)).toBe("out of range");
    expect(log).toHaveLength(5);
  });

  it("that are described incompletely are not taken", async () => {
    const short = { ...ANSWERS, describe_parameters: { descriptors: [] } };
    await expect(readParameters(wireOf(short), "/walk", "trajopt")).rejects.toThrow("describes 0 of 4");
  });
});
