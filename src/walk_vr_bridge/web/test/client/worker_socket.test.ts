// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
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

function setUp() {
  const worker = new FakeWorker();
  const socket = new WorkerSocket("ws://here/ws", worker);
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
      { what: "open", url: "ws://here/ws" },
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
});
