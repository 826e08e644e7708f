// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { Wire, type WireListener } from "../../src/client/wire";
import { FakeClock, FakeSocket } from "./fakes";

let sockets: FakeSocket[];
let clock: FakeClock;
let log: string[];
let wire: Wire;

beforeEach(() => {
  sockets = [];
  clock = new FakeClock();
  log = [];
  const listener: WireListener = {
    opening: () => log.push("opening"),
    opened: () => log.push("opened"),
    closed: (code, _reason, retryMs) => log.push(`closed ${code} ${retryMs}`),
    complained: (sentence) => log.push(sentence),
  };
  const make = (): FakeSocket => {
    sockets.push(new FakeSocket());
    return sockets.at(-1)!;
  };
  wire = new Wire(make, listener, clock);
});

const TYPE = { type: "nav_msgs/Path" };

describe("wire", () => {
  it("subscribes on opening and again after each reconnection", () => {
    const heard: unknown[] = [];
    wire.subscribe("/walk/path", { ...TYPE, compression: "cbor-raw" }, (message) => heard.push(message));
    wire.start();
    expect(sockets[0]!.sent).toEqual([]);
    sockets[0]!.open();
    expect(sockets[0]!.of("subscribe")).toMatchObject([
      { topic: "/walk/path", compression: "cbor-raw", queue_length: 1 },
    ]);
    sockets[0]!.break();
    clock.advance(10_000);
    sockets[1]!.open();
    expect(sockets[1]!.of("subscribe")).toHaveLength(1);
    sockets[1]!.say({ op: "publish", topic: "/walk/path", msg: { a: 1 } });
    expect(heard).toEqual([{ a: 1 }]);
  });

  it("waits longer after each failure, up to a limit, and starts anew after a success", () => {
    wire.start();
    const waits: number[] = [];
    for (let attempt = 0; attempt < 8; attempt++) {
      sockets.at(-1)!.break();
      waits.push(Number(log.at(-1)!.split(" ")[2]));
      clock.advance(waits.at(-1)!);
    }
    expect(waits).toEqual([250, 500, 1000, 2000, 4000, 8000, 8000, 8000]);
    sockets.at(-1)!.open();
    sockets.at(-1)!.break();
    expect(log.at(-1)).toBe("closed 1006 250");
  });

  it("does not come back where it is not allowed", () => {
    wire.start();
    sockets[0]!.break(1008, "no role");
    clock.advance(60_000);
    expect(sockets).toHaveLength(1);
    expect(log.at(-1)).toBe("closed 1008 null");
  });

  it("gives up a line that has fallen silent, and keeps one that speaks", () => {
    wire.start();
    sockets[0]!.open();
    for (let second = 0; second < 30; second++) {
      clock.advance(1000);
      sockets[0]!.say({ op: "status", level: "none", msg: "" });
    }
    expect(sockets).toHaveLength(1);
    clock.advance(13_000);
    expect(log).toContain("closed 1006 250");
    expect(sockets).toHaveLength(2);
  });

  it("answers calls by their id, and fails them with the reason, the limit, or the lost line", async () => {
    wire.start();
    await expect(wire.call("/walk/undo")).rejects.toThrow("no connection");
    sockets[0]!.open();
    const [first, second, third, fourth] = [1, 2, 3, 4].map(() => wire.call("/walk/undo", {}, 5000));
    const ids = sockets[0]!.of("call_service").map(({ id }) => id);
    sockets[0]!.say({ op: "service_response", id: ids[1], result: true, values: { success: true } });
    sockets[0]!.say({ op: "service_response", id: ids[0], result: false, values: "not allowed" });
    await expect(second).resolves.toEqual({ success: true });
    await expect(first).rejects.toThrow("not allowed");
    const late = expect(third).rejects.toThrow("did not answer within 5 s");
    const lost = expect(wire.call("/walk/redo", {}, 60_000)).rejects.toThrow("connection was lost");
    const alsoLate = expect(fourth).rejects.toThrow("did not answer");
    clock.advance(5000);
    sockets[0]!.break();
    await Promise.all([late, lost, alsoLate]);
  });

  it("lives on after messages that cannot be read or used", () => {
    wire.subscribe("/t", TYPE, () => {
      throw new Error("bad pose");
    });
    wire.start();
    sockets[0]!.open();
    for (const data of ["{", "null", "7", new ArrayBuffer(0), new Uint8Array([0xff, 1, 2]).buffer]) {
      sockets[0]!.onmessage?.({ data });
    }
    sockets[0]!.say({ op: "publish", topic: "/t", msg: {} });
    sockets[0]!.say({ op: "publish", topic: "/unknown", msg: {} });
    expect(log.filter((line) => line.startsWith("A message of the server could not be read"))).toHaveLength(5);
    expect(log.at(-1)).toBe("A message on /t was not used: Error: bad pose");
    expect(wire.open).toBe(true);
  });

  it("stops for good", () => {
    wire.start();
    sockets[0]!.open();
    wire.stop();
    clock.advance(60_000);
    expect(sockets).toHaveLength(1);
    expect(wire.publish("/t", {})).toBe(false);
  });
});
