// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A WebSocket in a thread of its own: see `worker_socket.ts`. */

import { type Letter, Postbox } from "./postbox";
import type { FromWorker, ToWorker } from "./worker_socket";

/** How long a full postbox is left alone [ms]. */
const AGAIN_MS = 4;

let socket: WebSocket | null = null;
let postbox: Postbox | null = null;
let farewell: FromWorker | null = null;
let again = 0;
const waiting: Letter[] = [];

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

function open(url: string, shared: SharedArrayBuffer | null): void {
  postbox = shared && new Postbox(shared);
  socket = new WebSocket(url);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => tell({ what: "open" });
  socket.onerror = () => tell({ what: "error" });
  socket.onmessage = ({ data }: MessageEvent<Letter>) => {
    if (!postbox) tell({ what: "message", data }, typeof data === "string" ? [] : [data]);
    else {
      waiting.push(data);
      hand();
    }
  };
  socket.onclose = ({ code, reason }) => {
    farewell = { what: "close", code, reason };
    hand();
  };
}

/** Hands over what waits, in its order, and last that the socket is closed. */
function hand(): void {
  let handed = 0;
  while (postbox && handed < waiting.length && postbox.put(waiting[handed]!)) handed += 1;
  waiting.splice(0, handed);
  if (postbox) tell({ what: "look" });
  clearTimeout(again);
  if (waiting.length) again = self.setTimeout(hand, AGAIN_MS);
  else if (farewell) tell(farewell);
}

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if (data.what === "open") open(data.url, data.shared);
  else if (data.what === "send") socket?.send(data.text);
  else socket?.close(data.code, data.reason);
};
