// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The study's events: kept in order, published when there is a connection, and written out at the end. */

export type EventName = "participant" | "condition" | "task" | "answer" | "score" | "end";

export interface StudyEvent {
  readonly atMs: number;
  readonly name: EventName;
  readonly message: string;
  readonly values: Readonly<Record<string, string>>;
}

export class StudyLog {
  readonly events: StudyEvent[] = [];
  private published = 0;

  /** @param publish says whether it took the message: false where there is no connection. */
  constructor(private readonly publish: (message: unknown) => boolean) {}

  add(event: StudyEvent): void {
    this.events.push(event);
    this.flush();
  }

  /** Publishes what waits, in order; to be called again when there is a connection. */
  flush(): void {
    while (this.published < this.events.length && this.publish(messageOf(this.events[this.published]!)))
      this.published++;
  }

  get waiting(): number {
    return this.events.length - this.published;
  }
}

/** A diagnostic_msgs/DiagnosticArray; the page's own time goes with it, as the bridge stamps the time of arrival. */
function messageOf({ atMs, name, message, values }: StudyEvent): unknown {
  const pairs = Object.entries({ at_ms: String(atMs), ...values }).map(([key, value]) => ({ key, value }));
  return { status: [{ level: 0, name, message, hardware_id: "", values: pairs }] };
}

const COLUMNS = ["at_ms", "participant", "condition", "event", "key", "value"] as const;

/** Returns the events as CSV (RFC 4180), a line per value. */
export function eventsToCsv(events: readonly StudyEvent[]): string {
  const lines = events.flatMap(({ atMs, name, values }) => {
    const { participant = "", condition = "", ...others } = values;
    const rest = Object.entries(others);
    return (rest.length > 0 ? rest : [["", ""]]).map(([key, value]) => [
      String(atMs),
      participant,
      condition,
      name,
      key!,
      value!,
    ]);
  });
  return [[...COLUMNS], ...lines].map((line) => line.map(cell).join(",")).join("\r\n") + "\r\n";
}

function cell(text: string): string {
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

export function eventsToJson(events: readonly StudyEvent[]): string {
  return JSON.stringify({ study: 1, events }, null, 1);
}
