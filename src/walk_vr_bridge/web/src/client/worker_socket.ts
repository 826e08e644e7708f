// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/**
 * A WebSocket that listens in a worker: a browser that draws frame after frame lets the sockets of the page itself wait, see
 * docs/design.md. What it hears lies in a postbox that the page empties at the begin of each frame.
 */

import { Postbox } from "./postbox";
import type { SocketLike } from "./wire";

export type ToWorker =
  | { readonly what: "open"; readonly url: string; readonly shared: SharedArrayBuffer | null }
  | { readonly what: "send"; readonly text: string }
  | { readonly what: "close"; readonly code?: number; readonly reason?: string };

export type FromWorker =
  | { readonly what: "open" }
  | { readonly what: "error" }
  /** Something lies in the postbox. */
  | { readonly what: "look" }
  /** Where there is no postbox. */
  | { readonly what: "message"; readonly data: string | ArrayBuffer }
  | { readonly what: "close"; readonly code: number; readonly reason: string };

/** What of a worker is used; tests put their own in its place. */
export interface WorkerLike {
  onmessage: ((event: { data: FromWorker }) => void) | null;
  onerror: (() => void) | null;
  postMessage(message: ToWorker): void;
  terminate(): void;
}

const [CONNECTING, OPEN, CLOSING, CLOSED] = [0, 1, 2, 3];

export class WorkerSocket implements SocketLike {
  /** Binary messages are buffers; nothing else is asked for. */
  binaryType = "arraybuffer";
  readyState = CONNECTING;
  onopen: SocketLike["onopen"] = null;
  onclose: SocketLike["onclose"] = null;
  onmessage: SocketLike["onmessage"] = null;
  onerror: SocketLike["onerror"] = null;

  constructor(
    url: string,
    private readonly worker: WorkerLike,
    private readonly postbox: Postbox | null = Postbox.make(),
  ) {
    worker.onmessage = ({ data }) => this.heard(data);
    // Its script cannot be had while the bridge is gone, unless the browser has kept it: as a connection that fails.
    worker.onerror = () => this.heard({ what: "close", code: 1006, reason: "" });
    worker.postMessage({ what: "open", url, shared: postbox?.shared ?? null });
  }

  send(text: string): void {
    this.worker.postMessage({ what: "send", text });
  }

  close(code?: number, reason?: string): void {
    if (this.readyState >= CLOSING) return;
    this.readyState = CLOSING;
    this.worker.postMessage({ what: "close", code, reason });
  }

  empty(): void {
    for (let letter = this.postbox?.take(); letter != null; letter = this.postbox?.take()) this.onmessage?.({ data: letter });
  }

  private heard(said: FromWorker): void {
    this.empty();
    if (said.what === "message") this.onmessage?.(said);
    else if (said.what === "error") this.onerror?.();
    else if (said.what === "open") {
      this.readyState = OPEN;
      this.onopen?.();
    } else if (said.what === "close") {
      this.readyState = CLOSED;
      this.worker.terminate();
      this.onclose?.(said);
    }
  }
}

/** Opens a socket in a new worker. */
export function openInWorker(url: string): SocketLike {
  const worker = new Worker(new URL("./socket.worker.ts", import.meta.url), { type: "module" });
  return new WorkerSocket(url, worker as WorkerLike);
}
