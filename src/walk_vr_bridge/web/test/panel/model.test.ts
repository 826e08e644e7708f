// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { nextDwell } from "../../src/panel/tour";
import { find, keypoint, parameter, setUp, widgets } from "./fixtures";

describe("the panel's model", () => {
  it("lists the keypoints in the order of the tour, with what is laid down about each", () => {
    const { model } = setUp();
    const items = widgets(model.sections()).filter((widget) => widget.kind === "item");
    expect(items).toMatchObject([
      { number: "1", title: "Room 3", detail: "start", tone: "start" },
      { number: "2", title: "Room 7", detail: "locked", tone: "plain" },
      { number: "3", title: "Room 9", detail: "no floor below", tone: "warn" },
    ]);
  });

  it("offers what can be done with the chosen keypoint, and does it", () => {
    const { model, store, asked } = setUp();
    store.patch("selection", { keypoint: 7 });
    for (const id of ["lock", "start", "end", "earlier", "later", "half-way", "delete"])
      find(model, "button", id).run();
    find(model, "stepper", "dwell:7").step(1);
    expect(asked).toEqual([
      ["unlock", 7],
      ["setStart", 7],
      ["setEnd", 7],
      ["reorder", 7, "earlier"],
      ["reorder", 7, "later"],
      ["insertHalfWay", 7],
      ["remove", 7],
      ["dwell", 7, 1],
    ]);
    expect(find(model, "button", "lock")).toMatchObject({ compact: true, pressed: true });
    store.patch("selection", { keypoint: 3 });
    expect(find(model, "button", "lock").label).toContain("passes exactly through");
    find(model, "button", "start").run();
    expect(asked.at(-1)).toEqual(["freeEnd", 3]);
  });

  it("says nothing of clearance or collisions before all of the path has been measured", () => {
    const { model, store } = setUp();
    const { path } = store.state;
    Object.assign(path, { count: 4, clearanceM: new Float32Array([0.5, 0.3, NaN, NaN]), heightM: new Float32Array(4) });
    model.open("view");
    for (const pathColour of ["clearance", "height", "collisions"] as const) {
      store.patch("settings", { pathColour });
      expect(find(model, "note", "path-unknown").text).toBe("Being measured along the path: 50 %");
    }
    path.clearanceM.fill(0.4, 2);
    expect(find(model, "note", "free").text).toBe("The walker touches nothing.");
  });

  it("gives a viewer no way to change anything", () => {
    const { model, store, asked } = setUp();
    store.patch("session", { role: "viewer" });
    store.patch("selection", { keypoint: 7 });
    for (const tab of ["tour", "tune", "walk"] as const) {
      model.open(tab);
      for (const widget of widgets(model.sections())) {
        if (widget.kind === "button" && !widget.disabled) widget.run();
        if ((widget.kind === "slider" || widget.kind === "toggle") && !("disabled" in widget && widget.disabled)) {
          expect(["add-near", "vignette", "fade", "snapTurn", "teleport"]).toContain(widget.id);
        }
      }
    }
    expect(asked).toEqual([]);
  });

  it("makes sliders from the server's ranges and sets what they are moved to", () => {
    const { model, asked, store } = setUp();
    model.open("tune");
    const distance = find(model, "slider", "trajopt.clearance_m");
    expect(distance.text(distance.position)).toBe("0.42 m");
    expect([distance.text(0), distance.text(1)]).toEqual(["0 m", "1.68 m"]);
    const smooth = find(model, "slider", "trajopt.weight_smoothness");
    expect(smooth.text(smooth.position)).toBe("1");
    expect([smooth.text(0), smooth.text(1)]).toEqual(["0", "1000"]);
    smooth.commit(1);
    expect(asked.at(-1)).toEqual(["setParameter", store.state.parameters[1], 1000]);
    find(model, "toggle", "optimiser").set(false);
    expect(asked.at(-1)).toEqual(["setParameter", store.state.parameters[0], "catmull_rom"]);
  });

  it("offers no slider and no optimiser switch that the planner does not have", () => {
    const { model, store } = setUp();
    store.set("parameters", [parameter("trajopt.clearance_m", 1)]);
    model.open("tune");
    expect(widgets(model.sections()).map(({ id }) => id)).toEqual(["trajopt.clearance_m"]);
  });

  it("says on every tab that the connection is gone, and tries again when told to", () => {
    const { model, store, asked } = setUp();
    store.patch("connection", { phase: "waiting", message: "The connection is lost." });
    for (const tab of ["tour", "view", "tune", "walk", "study"] as const) {
      model.open(tab);
      expect(find(model, "note", "connection").text).toBe("The connection is lost.");
    }
    find(model, "button", "retry").run();
    expect(asked).toEqual([["retry"]]);
  });

  it("shows in red only what has come to an end", () => {
    const { model, store } = setUp();
    const tones = (["connecting", "waiting", "refused"] as const).map((phase) => {
      store.patch("connection", { phase, message: phase === "connecting" ? "Connecting …" : "The connection is lost." });
      return find(model, "note", "connection").tone;
    });
    expect(tones).toEqual(["plain", "wait", "warn"]);
  });

  it("offers a better order only where it saves something", () => {
    const { model, store, asked } = setUp();
    expect(find(model, "button", "replan").label).toBe("Look for a better order");
    store.patch("offer", { betterOrderSavesM: 12.34 });
    expect(find(model, "button", "replan").label).toBe("Take a better order: 12.3 m shorter");
    find(model, "button", "replan").run();
    find(model, "choice", "order").choose("given");
    expect(asked).toEqual([["replan"], ["setParameter", store.state.parameters[3], "given"]]);
  });

  it("tells once of many changes at a time, and is asked no more when it is told nothing", () => {
    const { client, study } = setUp();
    const runs: (() => void)[] = [];
    const model = new (setUp().model.constructor as typeof import("../../src/panel/model").PanelModel)(
      client as never,
      study,
      (run) => runs.push(run),
    );
    let told = 0;
    model.onChange(() => told++);
    client.store.set("keypoints", [keypoint(1)]);
    client.store.patch("selection", { keypoint: 1 });
    expect([told, runs.length]).toEqual([0, 1]);
    runs[0]!();
    expect(told).toBe(1);
  });
});

describe("the stay at a keypoint", () => {
  it("steps up and down, and below walking through it is as set for all", () => {
    expect([
      nextDwell(null, 1),
      nextDwell(null, -1),
      nextDwell(0, -1),
      nextDwell(2.5, 1),
      nextDwell(2.5, -1),
      nextDwell(3600, 1),
    ]).toEqual([1, 0, null, 3, 2, 3600]);
  });
});
