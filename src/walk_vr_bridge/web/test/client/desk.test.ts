// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { editResult } from "../../src/client/answers";
import { EditDesk } from "../../src/client/desk";
import { change, EVENT } from "../../src/client/edits";
import { keypointsFromMarkers } from "../../src/client/markers";
import type { Vec3 } from "../../src/client/state";
import { initialState, Store } from "../../src/client/store";
import { FakeClock } from "./fakes";

interface Sent {
  header: { stamp: { sec: number; nanosec: number } };
  marker_name: string;
  event_type: number;
  menu_entry_id: number;
  pose: { position: { x: number; y: number; z: number } };
}

let store: Store;
let clock: FakeClock;
let desk: EditDesk;
let sent: Sent[];
let online: boolean;

const label = ({ header: { stamp } }: Sent): number => stamp.sec * 1e9 + stamp.nanosec;
const shown = (id: number): Vec3 => store.state.keypoints.find((keypoint) => keypoint.id === id)!.position;
const kinds = (): number[] => sent.map(({ event_type }) => event_type);

function markers(sec: number, places: Record<number, Vec3>, marks: object[] = []): unknown {
  const header = { frame_id: "map", stamp: { sec, nanosec: 0 } };
  const arrows = Object.entries(places).map(([id, [x, y, z]]) => {
    const pose = { position: { x, y, z }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
    return { header, ns: "keypoints", id: Number(id), action: 0, text: `Room ${id}`, pose };
  });
  return { markers: [...arrows, ...marks.map((mark) => ({ header, action: 0, ...mark }))] };
}

function answer(edit: Sent, outcome: string, more: { sec?: number; reason?: string; keypoint?: string } = {}): void {
  const values = {
    outcome,
    keypoint: more.keypoint ?? edit.marker_name,
    revision_ns: `${more.sec ?? 1}000000000`,
    edit_stamp_ns: String(label(edit)),
  };
  const pairs = Object.entries(values).map(([key, value]) => ({ key, value }));
  desk.answered(editResult({ level: 0, name: "", message: more.reason ?? outcome, hardware_id: "me", values: pairs }));
}

beforeEach(() => {
  store = new Store(initialState("me"));
  clock = new FakeClock();
  sent = [];
  online = true;
  const send = (message: Record<string, unknown>): boolean => {
    if (online) sent.push(message as unknown as Sent);
    return online;
  };
  desk = new EditDesk(store, send, clock);
  desk.view.receive(keypointsFromMarkers(markers(1, { 3: [0, 0, 1.6], 4: [5, 0, 1.6] })));
});

describe("a drag", () => {
  it("is shown at once and sent at most 90 times a second, the newest last", () => {
    desk.grab(3);
    for (let ms = 0; ms < 1000; ms++) {
      desk.drag(3, [ms, 0, 1.6]);
      expect(shown(3)[0]).toBe(ms);
      clock.advance(1);
    }
    clock.advance(50);
    const drags = sent.filter(({ event_type }) => event_type === EVENT.POSE_UPDATE);
    expect(drags.length).toBeGreaterThan(75);
    expect(drags.length).toBeLessThanOrEqual(91);
    expect(drags.at(-1)!.pose.position.x).toBe(999);
    expect(sent.map(label)).toEqual([...sent.map(label)].sort((a, b) => a - b));
  });

  it("says that it is still there, until it is let go", () => {
    desk.grab(3);
    clock.advance(9500);
    expect(kinds()).toEqual([EVENT.MOUSE_DOWN, EVENT.KEEP_ALIVE, EVENT.KEEP_ALIVE, EVENT.KEEP_ALIVE]);
    void desk.release(3, [1, 0, 1.6]);
    clock.advance(60_000);
    expect(kinds().at(-1)).toBe(EVENT.MOUSE_UP);
  });

  it("sends no preview behind its release", () => {
    desk.grab(3);
    desk.drag(3, [1, 0, 1.6]);
    desk.drag(3, [2, 0, 1.6]);
    void desk.release(3, [3, 0, 1.6]);
    clock.advance(1000);
    expect(kinds()).toEqual([EVENT.MOUSE_DOWN, EVENT.POSE_UPDATE, EVENT.MOUSE_UP]);
  });
});

describe("a release", () => {
  it("is shown where the hand put it until the server's revision shows it", async () => {
    const done = desk.release(3, [1, 0, 1.6]);
    desk.view.receive(keypointsFromMarkers(markers(2, { 3: [0, 0, 1.6], 4: [6, 0, 1.6] })));
    expect(shown(3)).toEqual([1, 0, 1.6]);
    expect(store.state.connection.unconfirmed).toBe(1);
    answer(sent.at(-1)!, "accepted", { sec: 3 });
    await done;
    expect(shown(3)).toEqual([1, 0, 1.6]);
    desk.view.receive(keypointsFromMarkers(markers(3, { 3: [1.1, 0, 1.6], 4: [6, 0, 1.6] })));
    expect(shown(3)).toEqual([1.1, 0, 1.6]);
    expect(store.state.keypoints[0]!.pending).toBe(false);
    expect(store.state.connection.unconfirmed).toBe(0);
  });

  it("goes back where it was and says why, and where, when it is refused", async () => {
    const done = desk.release(3, [1, 9, 1.6]);
    answer(sent.at(-1)!, "refused", { reason: "in a wall" });
    await expect(done).resolves.toMatchObject({ outcome: "refused" });
    expect(shown(3)).toEqual([0, 0, 1.6]);
    expect(store.state.refusals).toMatchObject([{ keypoint: 3, place: [1, 9, 1.6], reason: "in a wall" }]);
  });

  it("is refused by the number that is shown, which is the keypoint's place in the tour", async () => {
    const done = desk.release(4, [6, 0, 1.6]);
    answer(sent.at(-1)!, "refused", { reason: "keypoint 4 is locked: unlock it first" });
    await done;
    expect(store.state.refusals).toMatchObject([{ keypoint: 4, reason: "keypoint 2 is locked: unlock it first" }]);
  });

  it("that is answered late does not take back a newer one", async () => {
    const first = desk.release(3, [1, 0, 1.6]);
    void desk.release(3, [2, 0, 1.6]);
    answer(sent[0]!, "refused", { reason: "in a wall" });
    await first;
    expect(shown(3)).toEqual([2, 0, 1.6]);
  });

  it("made without a connection is sent when there is one", async () => {
    online = false;
    const done = desk.release(3, [1, 0, 1.6]);
    expect([sent.length, store.state.connection.unconfirmed]).toEqual([0, 1]);
    online = true;
    desk.reconnected();
    expect(sent).toHaveLength(1);
    answer(sent[0]!, "accepted", { sec: 2 });
    await expect(done).resolves.toMatchObject({ outcome: "accepted" });
  });

  it("whose answer was lost with the connection is sent again", () => {
    void desk.release(3, [1, 0, 1.6]);
    desk.reconnected();
    expect(sent.map(label)).toEqual([label(sent[0]!), label(sent[0]!)]);
  });
});

describe("after a lost connection", () => {
  it("an insertion that may be done is reported and not done twice", async () => {
    const done = desk.perform(change("insert", null, { position: [2, 0, 1.6] }));
    desk.reconnected();
    await expect(done).resolves.toMatchObject({ outcome: "lost" });
    expect(sent).toHaveLength(1);
    expect(store.state.refusals[0]!.reason).toContain("new keypoint was confirmed");
    expect(store.state.refusals[0]!.place).toEqual([2, 0, 1.6]);
  });

  it("a deletion that finds its keypoint gone is done", async () => {
    const done = desk.perform(change("remove", 4));
    desk.view.receive(keypointsFromMarkers(markers(2, { 3: [0, 0, 1.6] })));
    desk.reconnected();
    answer(sent.at(-1)!, "refused", { reason: "there is no keypoint 4" });
    await expect(done).resolves.toMatchObject({ outcome: "accepted" });
    expect(store.state.refusals).toEqual([]);
  });

  it("a held keypoint is taken hold of again", () => {
    desk.grab(3);
    desk.reconnected();
    expect(kinds()).toEqual([EVENT.MOUSE_DOWN, EVENT.MOUSE_DOWN]);
  });
});

describe("refusals", () => {
  it("of one drag along a wall are one until some time has passed", () => {
    desk.grab(3);
    for (let index = 0; index < 100; index++) {
      desk.drag(3, [index, 0, 1.6]);
      answer(sent.at(-1)!, "refused", { reason: "in a wall" });
      clock.advance(20);
    }
    expect(store.state.refusals).toHaveLength(1);
    clock.advance(3000);
    answer(sent.at(-1)!, "refused", { reason: "in a wall" });
    expect(store.state.refusals).toHaveLength(2);
  });
});

describe("keypoint markers", () => {
  it("carry what is laid down about each", () => {
    const pose = { position: { x: 1, y: 2, z: 3 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
    const marks = [
      { ns: "unreachable", id: 4, text: "not connected on foot", pose },
      { ns: "look_at", id: 3, text: "", pose },
      { ns: "dwell", id: 3, text: "2.5 s", pose },
      { ns: "locked", id: 3, text: "", pose },
      { ns: "start", id: 3, text: "start", pose },
      { ns: "end", id: 4, text: "end", pose },
      { ns: "keypoints", id: 9, action: 2, text: "", pose },
    ];
    const { keypoints, revision } = keypointsFromMarkers(markers(7, { 3: [0, 0, 1], 4: [1, 0, 1] }, marks));
    expect(revision).toBe("7000000000");
    expect(keypoints).toMatchObject([
      {
        id: 3,
        label: "Room 3",
        locked: true,
        start: true,
        end: false,
        dwellS: 2.5,
        lookAt: [1, 2, 3],
        unreachable: "",
      },
      {
        id: 4,
        locked: false,
        start: false,
        end: true,
        dwellS: null,
        lookAt: null,
        unreachable: "not connected on foot",
      },
    ]);
  });

  it.each([
    ["no markers", { markers: [] }],
    ["finite number", markers(1, { 1: [NaN, 0, 0] })],
    ["a list", { markers: null }],
    ["seconds|reads like", markers(1, { 1: [0, 0, 0] }, [{ ns: "dwell", id: 1, text: "long" }])],
  ])("are refused with %s", (reason, message) => {
    expect(() => keypointsFromMarkers(message)).toThrow(new RegExp(reason));
  });
});
