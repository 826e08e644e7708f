// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A clock that is turned by hand, and a socket whose other end is the test. */
import type { Clock, SocketLike } from "../../src/client/wire";

export class FakeClock implements Clock {
  private timers: { at: number; run: () => void; id: number }[] = [];
  private id = 0;
  constructor(public ms = 1_700_000_000_000) {}
  now = (): number => this.ms;
  random = (): number => 1;
  setTimer = (run: () => void, ms: number): number => {
    this.timers.push({ at: this.ms + ms, run, id: ++this.id });
    return this.id;
  };
  clearTimer = (timer: number): void => {
    this.timers = this.timers.filter(({ id }) => id !== timer);
  };
  advance(ms: number): void {
    const end = this.ms + ms;
    for (;;) {
      const due = this.timers.filter(({ at }) => at <= end).sort((a, b) => a.at - b.at || a.id - b.id)[0];
      if (!due) break;
      this.clearTimer(due.id);
      this.ms = Math.max(this.ms, due.at);
      due.run();
    }
    this.ms = end;
  }
}

export class FakeSocket implements SocketLike {
  binaryType = "";
  readyState = 0;
  onopen: (() => void) | null = null;
  onclose: ((event: { code: number; reason: string }) => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onerror: (() => void) | null = null;
  readonly sent: Record<string, unknown>[] = [];
  send(data: string): void {
    this.sent.push(JSON.parse(data) as Record<string, unknown>);
  }
  close(): void {
    this.readyState = 3;
  }
  open(): void {
    this.readyState = 1;
    this.onopen?.();
  }
  say(operation: unknown): void {
    this.onmessage?.({ data: JSON.stringify(operation) });
  }
  break(code = 1006, reason = ""): void {
    this.readyState = 3;
    this.onclose?.({ code, reason });
  }
  of(op: string): Record<string, unknown>[] {
    return this.sent.filter((one) => one.op === op);
  }
}
