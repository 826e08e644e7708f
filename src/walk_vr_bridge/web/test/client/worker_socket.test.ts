// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Postbox } from "../../src/client/postbox";
import { WorkerSocket, type ToWorker, type WorkerLike } from "../../src/client/worker_socket";

class FakeWorker implements WorkerLike {
  onmessage: WorkerLike["onmessage"] = null;
  onerror: WorkerLike["onerror"] = null;
  readonly asked: ToWorker[] = [];
  ended = false;
  postMessage(message: ToWorker): void {
    this.asked.push(message);
  }
  terminate(): void {
    this.ended = true;
  }
}

function setUp(postbox: Postbox | null = null) {
  const worker = new FakeWorker();
  const socket = new WorkerSocket("ws://here/ws", worker, postbox);
  const told: unknown[] = [];
  socket.onopen = () => told.push("open");
  socket.onmessage = ({ data }) => told.push(data);
  socket.onclose = ({ code, reason }) => told.push([code, reason]);
  return { worker, socket, told };
}

describe("a socket in a worker", () => {
  it("opens, sends and hears as one of the page does", () => {
    const { worker, socket, told } = setUp();
    expect(socket.readyState).toBe(0);
    worker.onmessage!({ data: { what: "open" } });
    expect(socket.readyState).toBe(1);
    socket.send("{}");
    worker.onmessage!({ data: { what: "message", data: "hello" } });
    expect(worker.asked).toEqual([
      { what: "open", url: "ws://here/ws", shared: null },
      { what: "send", text: "{}" },
    ]);
    expect(told).toEqual(["open", "hello"]);
  });

  it("is closed where its worker cannot begin, so that another is tried", () => {
    const { worker, socket, told } = setUp();
    worker.onerror!();
    expect([socket.readyState, worker.ended, told.at(-1)]).toEqual([3, true, [1006, ""]]);
  });

  it("ends its worker once it is closed, and closes once", () => {
    const { worker, socket, told } = setUp();
    worker.onmessage!({ data: { what: "open" } });
    socket.close(1000);
    socket.close(1000);
    expect(worker.asked.filter(({ what }) => what === "close")).toHaveLength(1);
    expect(worker.ended).toBe(false);
    worker.onmessage!({ data: { what: "close", code: 1000, reason: "bye" } });
    expect([socket.readyState, worker.ended, told.at(-1)]).toEqual([3, true, [1000, "bye"]]);
  });

  it("hears what lies in the postbox when it is told to look, at the begin of a frame, and before it closes", () => {
    const postbox = Postbox.make()!;
    const { worker, socket, told } = setUp(postbox);
    const writer = new Postbox(postbox.shared);
    expect(worker.asked).toEqual([{ what: "open", url: "ws://here/ws", shared: postbox.shared }]);
    writer.put("one");
    worker.onmessage!({ data: { what: "look" } });
    writer.put("two");
    socket.empty();
    writer.put("three");
    worker.onmessage!({ data: { what: "close", code: 1006, reason: "" } });
    expect(told).toEqual(["one", "two", "three", [1006, ""]]);
  });
});
