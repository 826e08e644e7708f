// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { showValue } from "../../src/client/parameters";
import type { Parameter, ParameterValue } from "../../src/client/state";
import { orderOf, TASKS } from "../../src/study/design";
import { eventsToCsv, eventsToJson, StudyLog } from "../../src/study/events";
import { StudyRun } from "../../src/study/run";
import { susScore } from "../../src/study/sus";
import { TLX_PAIRS, TLX_SCALES } from "../../src/study/tlx";
import { find, setUp, widgets } from "../panel/fixtures";

type World = ReturnType<typeof setUp>;

/** Goes through one condition by the panel's own widgets. */
function goThrough(world: World, seconds: number): void {
  const { model, clock } = world;
  for (const _ of TASKS) {
    find(model, "button", "task-begin").run();
    clock.ms += seconds * 1000;
    find(model, "button", "task-done").run();
  }
  for (let item = 0; item < 10; item++) {
    find(model, "scale", `sus:${item}`).choose(item % 2 === 0 ? 4 : 0);
    find(model, "button", "next").run();
  }
  TLX_SCALES.forEach(({ key }, index) => {
    find(model, "scale", `tlx:${key}`).choose(index);
    find(model, "button", "next").run();
  });
  for (const [first] of TLX_PAIRS) {
    find(model, "button", `pair-${first}`).run();
    find(model, "button", "next").run();
  }
}

function begun(): World {
  const world = setUp();
  world.model.open("study");
  find(world.model, "button", "begin").run();
  return world;
}

describe("the order of the conditions", () => {
  it("is balanced: as many begin with one as with the other", () => {
    const first = Array.from({ length: 40 }, (_, index) => orderOf(index + 1)[0]);
    expect(first.filter((one) => one === "optimiser_on")).toHaveLength(20);
    for (let participant = 1; participant <= 40; participant++) expect(new Set(orderOf(participant)).size).toBe(2);
    for (const wrong of [0, -1, 1.5, NaN]) expect(() => orderOf(wrong)).toThrow(RangeError);
  });
});

describe("a study", () => {
  it("goes through both conditions, switches the optimiser, times the tasks and computes the scores", () => {
    const world = begun();
    goThrough(world, 30);
    goThrough(world, 10);
    expect(world.asked.map(([name, , value]) => [name, value])).toEqual([
      ["setParameter", "catmull_rom"],
      ["setParameter", "optimised"],
    ]);
    // Ratings 0, 5 ... 25 by scale; the first of each pair chosen: weights 5, 4, 3, 2, 1, 0.
    const tlx = { rawTlx: 12.5, weightedTlx: (0 * 5 + 5 * 4 + 10 * 3 + 15 * 2 + 20 * 1) / 15 };
    expect(world.study.run.scores).toEqual([
      { condition: "optimiser_off", sus: 100, ...tlx, taskS: [30, 30, 30] },
      { condition: "optimiser_on", sus: 100, ...tlx, taskS: [10, 10, 10] },
    ]);
    expect(world.study.run.step).toBe("done");
  });

  it("tells everything as events, from which the scores can be computed again", () => {
    const world = begun();
    goThrough(world, 30);
    const events = world.published.map(({ status }) => ({
      name: status[0]!.name,
      values: new Map(status[0]!.values.map(({ key, value }) => [key, value])),
    }));
    const names = events.map(({ name }) => name);
    const count = (name: string): number => names.filter((one) => one === name).length;
    expect([count("participant"), count("condition"), count("task"), count("answer"), count("score")]).toEqual([
      1, 2, 6, 31, 1,
    ]);
    const sus = events
      .filter(({ values }) => values.get("instrument") === "sus")
      .map(({ values }) => Number(values.get("value")));
    expect(susScore(sus)).toBe(Number(events.find(({ name }) => name === "score")!.values.get("sus")));
    expect(events.every(({ values }) => values.get("participant") === "1" && values.get("condition"))).toBe(true);
  });

  it("keeps events while there is no connection and sends them in order afterwards", () => {
    const world = setUp();
    world.model.open("study");
    world.client.online = false;
    find(world.model, "button", "begin").run();
    find(world.model, "button", "task-begin").run();
    expect([world.published.length, world.study.log.waiting]).toEqual([0, 3]);
    world.client.online = true;
    world.store.patch("connection", { phase: "connected" });
    expect(world.published.map(({ status }) => status[0]!.name)).toEqual(["participant", "condition", "task"]);
    expect(world.study.log.waiting).toBe(0);
  });

  it("counts an item of the SUS that is left out as the middle, and goes on from a rating only with one", () => {
    const world = begun();
    for (const _ of TASKS) {
      find(world.model, "button", "task-begin").run();
      find(world.model, "button", "task-give-up").run();
    }
    for (let item = 0; item < 10; item++) find(world.model, "button", "next").run();
    expect(world.study.run.sus).toEqual(Array(10).fill(3));
    expect(find(world.model, "button", "next").disabled).toBe(true);
    find(world.model, "button", "next").run();
    expect(world.study.run.question).toBe(0);
  });

  it("cannot begin where the optimiser cannot be switched", () => {
    const world = setUp();
    world.store.set("parameters", []);
    world.model.open("study");
    expect(find(world.model, "button", "begin").disabled).toBe(true);
    expect(find(world.model, "note", "no-switch").text).toContain("nothing to compare");
  });

  it("cannot be begun by who looks on", () => {
    const world = setUp();
    world.model.open("study");
    expect(find(world.model, "button", "begin").disabled).toBe(false);
    world.store.patch("session", { role: "viewer" });
    expect(find(world.model, "button", "begin").disabled).toBe(true);
  });

  it("shows who answers nothing of the experimenter's, and asks nobody to leave out a question", () => {
    const world = begun();
    const ids = (): string[] => widgets(world.model.sections()).map(({ id }) => id);
    expect(ids()).not.toContain("csv");
    world.study.run.step = "sus";
    expect(find(world.model, "button", "next")).toMatchObject({ label: "Leave out" });
    expect(find(world.model, "button", "next").tone).toBeUndefined();
    find(world.model, "button", "break-off").run();
    expect(ids()).toContain("csv");
  });

  it("can be broken off and keeps what was recorded", () => {
    const world = begun();
    find(world.model, "button", "break-off").run();
    expect(world.study.run.step).toBe("idle");
    expect(world.study.log.events.at(-1)).toMatchObject({ name: "end", values: { complete: "false" } });
  });
});

describe("the optimiser after a study", () => {
  const MODE = "trajopt.mode";

  /** The planner takes what it is asked for, unless it is out of reach. */
  function planner(world: World, before: string): { reached: boolean; mode: () => unknown } {
    const mode = (): unknown => world.store.state.parameters.find(({ name }) => name === MODE)!.value;
    const link = { reached: true, mode };
    showValue(world.store, MODE, before);
    const setParameter = ({ name }: Parameter, value: ParameterValue): Promise<boolean> => {
      if (link.reached) showValue(world.store, name, value);
      return Promise.resolve(link.reached);
    };
    Object.defineProperty(world.client, "actions", { value: { setParameter } });
    return link;
  }

  it.each(["optimised", "catmull_rom", "b_spline"])("is as it was before, %s, broken off or not", (before) => {
    const world = setUp();
    const { mode } = planner(world, before);
    world.model.open("study");
    find(world.model, "button", "begin").run();
    expect(mode()).toBe("catmull_rom");
    find(world.model, "button", "break-off").run();
    expect(mode()).toBe(before);
    find(world.model, "button", "begin").run();
    goThrough(world, 1);
    expect(mode()).toBe("optimised");
    goThrough(world, 1);
    expect([world.study.run.step, mode()]).toEqual(["done", before]);
  });

  it("is said not to be where that cannot be sent, and can be set back later", async () => {
    const world = setUp();
    const link = planner(world, "b_spline");
    world.model.open("study");
    find(world.model, "button", "begin").run();
    link.reached = false;
    find(world.model, "button", "break-off").run();
    await Promise.resolve();
    expect(find(world.model, "note", "not-set-back").text).toContain("b_spline");
    link.reached = true;
    find(world.model, "button", "set-back").run();
    await Promise.resolve();
    expect(link.mode()).toBe("b_spline");
    expect(() => find(world.model, "note", "not-set-back")).toThrow();
  });

  it("is set back once, by who has begun", () => {
    let times = 0;
    const port = { now: () => 0, use: () => undefined, remember: () => () => void times++ };
    const run = new StudyRun(new StudyLog(() => true), port);
    run.breakOff();
    expect(times).toBe(0);
    run.begin(1);
    run.breakOff();
    run.breakOff();
    expect(times).toBe(1);
  });
});

describe("the export", () => {
  it("is CSV that keeps commas, quotes and lines, and JSON of the same", () => {
    const event = {
      atMs: 5,
      name: "answer",
      message: "",
      values: { participant: "1", condition: "optimiser_on", note: 'a "b", c\nd' },
    } as const;
    expect(eventsToCsv([event])).toBe(
      'at_ms,participant,condition,event,key,value\r\n5,1,optimiser_on,answer,note,"a ""b"", c\nd"\r\n',
    );
    expect(JSON.parse(eventsToJson([event]))).toEqual({ study: 1, events: [event] });
  });
});
