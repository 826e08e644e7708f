// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Edits on their way: each is kept until it is answered, and sent again, or reported, after a lost connection. */

import type { EditResult } from "./answers";
import type { Clock } from "./wire";
import { describe, editMessage, repeatable, type Edit } from "./edits";

export interface OutboxPort {
  /** False where there is no connection. */
  send(message: Record<string, unknown>): boolean;
  unconfirmed(count: number): void;
}

export type Outcome = EditResult | { readonly outcome: "lost"; readonly reason: string; readonly label: number };

interface Waiting {
  readonly edit: Edit;
  readonly label: number;
  sent: boolean;
  readonly done: (outcome: Outcome) => void;
}

export class Outbox {
  private readonly waiting = new Map<number, Waiting>();
  private label = 0;

  constructor(
    private readonly port: OutboxPort,
    private readonly clock: Clock,
  ) {}

  /** A label for an edit: it rises, also over a reload of the page. */
  next(): number {
    this.label = Math.max(this.label + 1, Math.floor(this.clock.now()));
    return this.label;
  }

  /** Sends an edit that has to be confirmed, now or when there is a connection again. */
  post(edit: Edit, label = this.next()): Promise<Outcome> {
    return new Promise((done) => {
      const sent = this.port.send(editMessage(edit, label));
      this.waiting.set(label, { edit, label, sent, done });
      this.port.unconfirmed(this.waiting.size);
    });
  }

  /** Takes an answer; false where the edit was none that waits. */
  answer(result: EditResult): boolean {
    return this.finish(result.label, result);
  }

  /**
   * Goes on after a reconnection. What never left, or may be done twice without harm, is sent; what may have been done
   * already is reported as lost, as only the user can see whether it was.
   */
  reconnected(): void {
    for (const { edit, label, sent } of [...this.waiting.values()]) {
      if (sent && !repeatable(edit)) {
        const reason = `The connection was lost before ${describe(edit)} was confirmed: see whether it was done.`;
        this.finish(label, { outcome: "lost", reason, label });
      } else if (this.port.send(editMessage(edit, label))) {
        this.waiting.get(label)!.sent = true;
      }
    }
  }

  private finish(label: number, outcome: Outcome): boolean {
    const waiting = this.waiting.get(label);
    if (!waiting) return false;
    this.waiting.delete(label);
    this.port.unconfirmed(this.waiting.size);
    waiting.done(outcome);
    return true;
  }
}
