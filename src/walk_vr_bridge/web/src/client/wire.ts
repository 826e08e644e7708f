// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The rosbridge client: one socket that comes back by itself, with its subscriptions, and says when it is gone. */

import { decodeCbor } from "./cbor";

/** What of a WebSocket is used; tests put their own in its place. */
export interface SocketLike {
  binaryType: string;
  readonly readyState: number;
  onopen: (() => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onerror: (() => void) | null;
  send(data: string): void;
  close(code?: number, reason?: string): void;
  /** Hands over at once what has come, where it may wait to be fetched. */
  empty?(): void;
}

export interface Clock {
  now(): number;
  setTimer(run: () => void, ms: number): number;
  clearTimer(timer: number): void;
  random(): number;
}

export const BROWSER_CLOCK: Clock = {
  now: () => Date.now(),
  setTimer: (run, ms) => window.setTimeout(run, ms),
  clearTimer: (timer) => window.clearTimeout(timer),
  random: () => Math.random(),
};

export interface SubscribeOptions {
  readonly type: string;
  readonly compression?: "none" | "cbor" | "cbor-raw";
  readonly throttleMs?: number;
}

export interface WireListener {
  opening(): void;
  opened(): void;
  /** The socket is gone; the next attempt starts in `retryMs`, or never where that is null. */
  closed(code: number, reason: string, retryMs: number | null): void;
  /** A message that could not be read, or a status of the server. */
  complained(sentence: string): void;
}

export class WireError extends Error {
  override readonly name = "WireError";
}

type Handler = (message: unknown) => void;
interface Subscription extends SubscribeOptions {
  readonly handler: Handler;
}
interface Call {
  readonly resolve: (values: unknown) => void;
  readonly reject: (error: Error) => void;
  readonly timer: number;
}

const OPEN = 1;
const FIRST_RETRY_MS = 250;
const LAST_RETRY_MS = 8000;
const CALL_LIMIT_MS = 15000;
/** The server speaks at least once a second; a socket silent for longer than this is dead, whatever the browser says. */
const SILENCE_MS = 12000;
/** Codes after which trying again would end alike: the server knows the client and does not want it. */
const FINAL_CODES: ReadonlySet<number> = new Set([1008, 4401, 4403]);

export class Wire {
  private socket: SocketLike | null = null;
  private attempts = 0;
  private retry = 0;
  private watch = 0;
  private heardMs = 0;
  private calls = new Map<string, Call>();
  private serial = 0;
  private readonly subscriptions = new Map<string, Subscription>();
  private readonly advertised = new Map<string, string>();

  constructor(
    private readonly makeSocket: () => SocketLike,
    private readonly listener: WireListener,
    private readonly clock: Clock = BROWSER_CLOCK,
  ) {}

  get open(): boolean {
    return this.socket?.readyState === OPEN;
  }

  start(): void {
    this.clock.clearTimer(this.retry);
    if (this.socket) return;
    this.listener.opening();
    const socket = this.makeSocket();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.opened();
    socket.onmessage = (event) => this.heard(event.data);
    socket.onclose = (event) => this.lost(event.code, event.reason);
    this.socket = socket;
  }

  stop(): void {
    this.clock.clearTimer(this.retry);
    const socket = this.socket;
    this.drop("stopped");
    socket?.close(1000);
  }

  /** Hears at once what has come, instead of when the browser finds time. */
  look(): void {
    this.socket?.empty?.();
  }

  /** Hears a topic from now on, over every reconnection. One handler a topic. */
  subscribe(topic: string, options: SubscribeOptions, handler: Handler): void {
    this.subscriptions.set(topic, { ...options, handler });
    if (this.open) this.askFor(topic);
  }

  advertise(topic: string, type: string): void {
    this.advertised.set(topic, type);
    this.send({ op: "advertise", topic, type });
  }

  /** Sends a message now; false where there is no connection. */
  publish(topic: string, msg: unknown): boolean {
    return this.send({ op: "publish", topic, msg });
  }

  /** Returns the values of the service's answer. @throws WireError: refused, too late, or the connection was lost. */
  call(service: string, args: unknown = {}, limitMs = CALL_LIMIT_MS): Promise<unknown> {
    return new Promise((resolve, reject) => {
      const id = `call:${++this.serial}`;
      if (!this.send({ op: "call_service", id, service, args })) {
        reject(new WireError("there is no connection"));
        return;
      }
      const timer = this.clock.setTimer(() => {
        this.calls.delete(id);
        reject(new WireError(`${service} did not answer within ${limitMs / 1000} s`));
      }, limitMs);
      this.calls.set(id, { resolve, reject, timer });
    });
  }

  private send(operation: Record<string, unknown>): boolean {
    if (!this.socket || !this.open) return false;
    this.socket.send(JSON.stringify(operation));
    return true;
  }

  private askFor(topic: string): void {
    const wanted = this.subscriptions.get(topic);
    if (!wanted) return;
    const { type, compression = "none", throttleMs = 0 } = wanted;
    const id = `subscribe:${topic}`;
    this.send({ op: "subscribe", id, topic, type, compression, throttle_rate: throttleMs, queue_length: 1 });
  }

  private opened(): void {
    this.attempts = 0;
    this.heardMs = this.clock.now();
    this.watch = this.clock.setTimer(() => this.listen(), SILENCE_MS);
    for (const [topic, type] of this.advertised) this.send({ op: "advertise", topic, type });
    for (const topic of this.subscriptions.keys()) this.askFor(topic);
    this.listener.opened();
  }

  private listen(): void {
    const left = this.heardMs + SILENCE_MS - this.clock.now();
    if (left > 0) {
      this.watch = this.clock.setTimer(() => this.listen(), left);
      return;
    }
    // close() on a dead line can take minutes to say so; the socket is left behind at once.
    const socket = this.socket;
    this.lost(1006, "the server fell silent");
    socket?.close();
  }

  private heard(data: unknown): void {
    this.heardMs = this.clock.now();
    let operation: Record<string, unknown>;
    try {
      const value = typeof data === "string" ? (JSON.parse(data) as unknown) : decodeCbor(data as ArrayBuffer);
      if (typeof value !== "object" || value === null) throw new WireError("no operation");
      operation = value as Record<string, unknown>;
    } catch (error) {
      this.listener.complained(`A message of the server could not be read: ${String(error)}`);
      return;
    }
    if (operation.op === "publish") this.deliver(operation);
    else if (operation.op === "service_response") this.answer(operation);
    else if (operation.op === "status") this.listener.complained(String(operation.msg ?? ""));
  }

  private deliver(operation: Record<string, unknown>): void {
    const handler = this.subscriptions.get(String(operation.topic))?.handler;
    if (!handler) return;
    try {
      handler(operation.msg);
    } catch (error) {
      this.listener.complained(`A message on ${String(operation.topic)} was not used: ${String(error)}`);
    }
  }

  private answer(operation: Record<string, unknown>): void {
    const call = this.calls.get(String(operation.id));
    if (!call) return;
    this.calls.delete(String(operation.id));
    this.clock.clearTimer(call.timer);
    if (operation.result === false) call.reject(new WireError(String(operation.values ?? "refused")));
    else call.resolve(operation.values);
  }

  private lost(code: number, reason: string): void {
    if (!this.socket) return;
    this.drop(reason);
    const final = FINAL_CODES.has(code);
    const retryMs = final ? null : this.nextRetryMs();
    if (retryMs !== null) this.retry = this.clock.setTimer(() => this.start(), retryMs);
    this.listener.closed(code, reason, retryMs);
  }

  /** Doubles up to the limit; scattered by half, so that clients do not all come back at one instant. */
  private nextRetryMs(): number {
    const wait = Math.min(LAST_RETRY_MS, FIRST_RETRY_MS * 2 ** this.attempts++);
    return wait * (0.5 + 0.5 * this.clock.random());
  }

  private drop(reason: string): void {
    const socket = this.socket;
    this.socket = null;
    this.clock.clearTimer(this.watch);
    if (socket) socket.onopen = socket.onclose = socket.onmessage = null;
    const calls = this.calls;
    this.calls = new Map();
    for (const call of calls.values()) {
      this.clock.clearTimer(call.timer);
      call.reject(new WireError(`the connection was lost: ${reason || "no reason given"}`));
    }
  }
}
