// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A client with a store and actions that write down what is asked of them. */
import type { Actions } from "../../src/client/actions";
import type { Client } from "../../src/client/client";
import type { Keypoint, Parameter } from "../../src/client/state";
import { initialState, Store } from "../../src/client/store";
import { PanelModel } from "../../src/panel/model";
import { StudyView } from "../../src/study/view";
import type { Section, Widget } from "../../src/panel/widgets";

export function keypoint(id: number, more: Partial<Keypoint> = {}): Keypoint {
  return {
    id,
    position: [id, 0, 1.6],
    quat: [0, 0, 0, 1],
    label: `Room ${id}`,
    locked: false,
    start: false,
    end: false,
    dwellS: null,
    lookAt: null,
    unreachable: "",
    pending: false,
    ...more,
  };
}

export function parameter(name: string, value: number | boolean | string, more: Partial<Parameter> = {}): Parameter {
  const type = typeof value === "boolean" ? "boolean" : typeof value === "string" ? "string" : "double";
  return { node: "trajopt", name, type, description: "", unit: "", min: 0, max: 1e6, choices: [], value, ...more };
}

export function setUp() {
  const store = new Store(initialState("me"));
  store.patch("connection", { phase: "connected" });
  store.patch("session", { role: "editor" });
  store.set("keypoints", [
    keypoint(3, { start: true }),
    keypoint(7, { locked: true }),
    keypoint(9, { unreachable: "no floor below" }),
  ]);
  store.set("parameters", [
    parameter("trajopt.mode", "optimised"),
    parameter("trajopt.weight_smoothness", 1),
    parameter("trajopt.clearance_m", 0.42, { unit: "m", max: 10 }),
    parameter("sequencer.method", "auto", { node: "sequencer" }),
  ]);
  const asked: unknown[][] = [];
  const actions = new Proxy({} as Actions, {
    get:
      (_, name) =>
      (...args: unknown[]) => {
        asked.push([name, ...args]);
        return Promise.resolve(true);
      },
  });
  const published: { status: { name: string; values: { key: string; value: string }[] }[] }[] = [];
  const clock = { ms: 0 };
  const client = {
    store,
    actions,
    retry: () => asked.push(["retry"]),
    online: true,
    publishStudyEvent: (message: unknown) => client.online && Boolean(published.push(message as never)),
  };
  const saved: [string, string][] = [];
  const study = new StudyView(
    client as unknown as Client,
    (name, _type, text) => saved.push([name, text]),
    () => clock.ms,
  );
  const model = new PanelModel(client as unknown as Client, study, (run) => run());
  return { store, asked, client, study, model, published, clock, saved };
}

export function widgets(sections: readonly Section[]): Widget[] {
  return sections
    .flatMap((section) => section.widgets)
    .flatMap((widget) => (widget.kind === "row" ? [...widget.buttons] : [widget]));
}

export function find<K extends Widget["kind"]>(model: PanelModel, kind: K, id: string): Extract<Widget, { kind: K }> {
  const found = widgets(model.sections()).find((widget) => widget.kind === kind && widget.id === id);
  if (!found)
    throw new Error(
      `no ${kind} ${id} among ${widgets(model.sections())
        .map((one) => one.id)
        .join(", ")}`,
    );
  return found as Extract<Widget, { kind: K }>;
}
