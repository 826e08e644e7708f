// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/**
 * A WebSocket that listens in a worker: a browser that draws frame after frame lets the sockets of the page itself wait, see
 * docs/design.md.
 */

import type { SocketLike } from "./wire";

export type ToWorker =
  | { readonly what: "open"; readonly url: string }
  | { readonly what: "send"; readonly text: string }
  | { readonly what: "close"; readonly code?: number; readonly reason?: string };

export type FromWorker =
  | { readonly what: "open" }
  | { readonly what: "error" }
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
  ) {
    worker.onmessage = ({ data }) => this.heard(data);
    // Its script cannot be had while the bridge is gone, unless the browser has kept it: as a connection that fails.
    worker.onerror = () => this.heard({ what: "close", code: 1006, reason: "" });
    worker.postMessage({ what: "open", url });
  }

  send(text: string): void {
    this.worker.postMessage({ what: "send", text });
  }

  close(code?: number, reason?: string): void {
    if (this.readyState >= CLOSING) return;
    this.readyState = CLOSING;
    this.worker.postMessage({ what: "close", code, reason });
  }

  private heard(said: FromWorker): void {
    if (said.what === "message") this.onmessage?.(said);
    else if (said.what === "error") this.onerror?.();
    else if (said.what === "open") {
      this.readyState = OPEN;
      this.onopen?.();
    } else {
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
