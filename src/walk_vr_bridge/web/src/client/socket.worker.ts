// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A WebSocket in a thread of its own: see `worker_socket.ts`. */

import type { FromWorker, ToWorker } from "./worker_socket";

let socket: WebSocket | null = null;

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

function open(url: string): void {
  socket = new WebSocket(url);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => tell({ what: "open" });
  socket.onerror = () => tell({ what: "error" });
  socket.onclose = ({ code, reason }) => tell({ what: "close", code, reason });
  socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) =>
    tell({ what: "message", data }, typeof data === "string" ? [] : [data]);
}

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if (data.what === "open") open(data.url);
  else if (data.what === "send") socket?.send(data.text);
  else socket?.close(data.code, data.reason);
};
