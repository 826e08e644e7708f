// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The Study tab: the steps of a run as widgets of the panel. */

import type { Client } from "../client/client";
import type { ParameterValue } from "../client/state";
import { button } from "../panel/buttons";
import { optimiserSwitch } from "../panel/optimiser";
import type { Button, Section, Widget } from "../panel/widgets";
import { CONDITION_TITLES, orderOf, type Condition } from "./design";
import { eventsToCsv, eventsToJson, StudyLog } from "./events";
import { StudyRun } from "./run";
import { SUS_ENDS, SUS_ITEMS, SUS_POINTS } from "./sus";
import { TLX_MAX, TLX_PAIRS, TLX_SCALES, TLX_STEP, type TlxKey } from "./tlx";

export type Download = (name: string, type: string, text: string) => void;

const MOST_PARTICIPANTS = 999;

export class StudyView {
  readonly log: StudyLog;
  readonly run: StudyRun;
  private participant = 1;
  /** What the optimiser could not be set back to; null: nothing. */
  private owed: ParameterValue | null = null;
  private readonly listeners: (() => void)[] = [];

  constructor(
    private readonly client: Pick<Client, "store" | "actions" | "publishStudyEvent">,
    private readonly download: Download,
    now: () => number = Date.now,
  ) {
    this.log = new StudyLog((message) => client.publishStudyEvent(message));
    this.run = new StudyRun(this.log, {
      now,
      use: (condition) => this.use(condition),
      remember: () => this.remember(),
    });
    client.store.subscribe("connection", () => this.log.flush());
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  sections(): Section[] {
    const widgets = this.widgets();
    const rest = this.run.step === "idle" || this.run.step === "done" ? [] : [this.breakOff()];
    return [
      { id: "study", title: this.title(), widgets },
      { id: "results", title: this.run.scores.length > 0 ? "Scores" : "", widgets: this.scores() },
      { id: "study-end", title: "", widgets: [...this.exports(), ...rest] },
    ];
  }

  private title(): string {
    const { run } = this;
    if (run.step === "idle" || run.step === "done") return "User study";
    return `Participant ${run.participant} · part ${run.conditionNumber} of 2`;
  }

  private widgets(): Widget[] {
    switch (this.run.step) {
      case "idle":
      case "done":
        return this.invitation();
      case "task":
      case "working":
        return this.task();
      case "sus":
        return this.susItem();
      case "tlx":
        return this.tlxScale();
      case "pairs":
        return this.tlxPair();
    }
  }

  private invitation(): Widget[] {
    const { parameters, session } = this.client.store.state;
    const ready = optimiserSwitch(parameters) !== null;
    const [first] = orderOf(this.participant);
    const text =
      "Each participant does the same tasks with the optimiser off and on, and answers the SUS and the NASA-TLX after each.";
    const done = this.run.step === "done" ? [note("thanks", "Thank you, this is the end.", "good")] : [];
    const missing = ready
      ? []
      : [
          note(
            "no-switch",
            "The planner does not offer to switch its optimiser, so there is nothing to compare.",
            "warn",
          ),
        ];
    return [
      ...done,
      ...this.unset(),
      note("about", text, "plain"),
      {
        kind: "stepper",
        id: "participant",
        label: "Participant",
        value: String(this.participant),
        step: (by) =>
          this.change(() => (this.participant = Math.min(MOST_PARTICIPANTS, Math.max(1, this.participant + by)))),
      },
      note("order", `Begins with: ${CONDITION_TITLES[first].toLowerCase()}`, "plain"),
      ...missing,
      this.press("begin", "Begin", () => this.run.begin(this.participant), {
        tone: "primary",
        // Who looks on can switch nothing; the panel says so.
        disabled: !ready || session.role !== "editor",
      }),
    ];
  }

  private task(): Widget[] {
    const { run } = this;
    const head = [
      note("task-title", `Task ${run.taskNumber}: ${run.task.title}`, "title"),
      note("task", run.task.text, "plain"),
    ];
    if (run.step === "task") {
      return [...head, this.press("task-begin", "Start the task", () => run.beginTask(), { tone: "primary" })];
    }
    const done = this.press("task-done", "Done", () => run.endTask(true), { tone: "primary", icon: "check" });
    const give = this.press("task-give-up", "Cannot do it", () => run.endTask(false));
    return [...head, { kind: "row", id: "task-end", buttons: [done, give] }];
  }

  private susItem(): Widget[] {
    const { run } = this;
    const answer = run.sus[run.question] ?? null;
    return [
      note("progress", `Usability, ${run.question + 1} of ${SUS_ITEMS.length}`, "title"),
      {
        kind: "scale",
        id: `sus:${run.question}`,
        question: SUS_ITEMS[run.question]!,
        ends: SUS_ENDS,
        count: SUS_POINTS,
        value: answer === null ? null : answer - 1,
        text: (index) => String(index + 1),
        choose: (index) => this.change(() => run.answerSus(index + 1)),
      },
      this.steps(answer === null ? LEAVE_OUT : "Next"),
    ];
  }

  private tlxScale(): Widget[] {
    const { run } = this;
    const scale = TLX_SCALES[run.question]!;
    const rating = run.ratings[scale.key];
    return [
      note("progress", `Workload, ${run.question + 1} of ${TLX_SCALES.length}: ${scale.title}`, "title"),
      {
        kind: "scale",
        id: `tlx:${scale.key}`,
        question: scale.question,
        ends: scale.ends,
        count: TLX_MAX / TLX_STEP + 1,
        value: rating === undefined ? null : rating / TLX_STEP,
        text: (index) => String(index * TLX_STEP),
        choose: (index) => this.change(() => run.rate(index * TLX_STEP)),
      },
      this.steps("Next"),
    ];
  }

  private tlxPair(): Widget[] {
    const { run } = this;
    const chosen = run.pairs[run.question] ?? null;
    const buttons = TLX_PAIRS[run.question]!.map(
      (key): Button => this.press(`pair-${key}`, titleOf(key), () => run.compare(key), { pressed: chosen === key }),
    );
    return [
      note("progress", `Workload, comparison ${run.question + 1} of ${TLX_PAIRS.length}`, "title"),
      note("pair", "Which of the two contributed more to the workload of these tasks?", "plain"),
      { kind: "row", id: `pair:${run.question}`, buttons },
      this.steps("Next"),
    ];
  }

  private steps(next: string): Widget {
    const { run } = this;
    const back = this.press("back", "Back", () => run.back(), { disabled: run.question === 0 });
    // What is left out is not what one is asked for.
    const more = next === LEAVE_OUT ? {} : { tone: "primary" as const, disabled: !run.answered };
    const on = this.press("next", next, () => run.next(), more);
    return { kind: "row", id: "steps", buttons: [back, on] };
  }

  private scores(): Widget[] {
    return this.run.scores.map(({ condition, sus, rawTlx, weightedTlx, taskS }) => {
      const total = taskS.reduce((sum, seconds) => sum + seconds, 0);
      const text = `SUS ${sus} · TLX ${weightedTlx.toFixed(1)} (raw ${rawTlx.toFixed(1)}) · tasks ${total.toFixed(0)} s`;
      return note(condition, `${CONDITION_TITLES[condition]}: ${text}`, "plain");
    });
  }

  private exports(): Widget[] {
    const { events } = this.log;
    const { step } = this.run;
    // Who answers sees questions, and nothing that is the experimenter's.
    if (events.length === 0 || (step !== "idle" && step !== "done")) return [];
    const csv = button("csv", "CSV", () => this.download("study.csv", "text/csv", eventsToCsv(events)), {
      icon: "download",
    });
    const json = button("json", "JSON", () => this.download("study.json", "application/json", eventsToJson(events)), {
      icon: "download",
    });
    return [{ kind: "row", id: "exports", buttons: [csv, json] }];
  }

  private breakOff(): Widget {
    return this.press("break-off", "Break off", () => this.run.breakOff());
  }

  private use(condition: Condition): void {
    const found = optimiserSwitch(this.client.store.state.parameters);
    if (found) void this.client.actions.setParameter(found.parameter, found.valueFor(condition === "optimiser_on"));
  }

  /** The optimiser as it is now, whichever way the study leaves it. */
  private remember(): () => void {
    this.owed = null;
    const before = optimiserSwitch(this.client.store.state.parameters)?.parameter.value;
    return () => {
      if (before !== undefined) void this.setBack(before);
    };
  }

  private async setBack(value: ParameterValue): Promise<void> {
    const now = optimiserSwitch(this.client.store.state.parameters)?.parameter;
    if (!now || now.value === value) return;
    const taken = await this.client.actions.setParameter(now, value);
    this.change(() => (this.owed = taken ? null : value));
  }

  /** Says that the optimiser is not as it was before the study, until it is. */
  private unset(): Widget[] {
    const { owed } = this;
    const now = optimiserSwitch(this.client.store.state.parameters)?.parameter;
    if (owed === null || now?.value === owed) return [];
    const text = `The optimiser could not be set back to how it was before the study: ${owed}.`;
    return [
      note("not-set-back", text, "warn"),
      this.press("set-back", "Set it back", () => void this.setBack(owed), {
        disabled: this.client.store.state.session.role !== "editor",
      }),
    ];
  }

  private press(id: string, label: string, run: () => void, more: Partial<Button> = {}): Button {
    return button(id, label, () => this.change(run), more);
  }

  private change(run: () => void): void {
    run();
    for (const listener of this.listeners) listener();
  }
}

const LEAVE_OUT = "Leave out";

function note(id: string, text: string, tone: "plain" | "good" | "warn" | "title"): Widget {
  return { kind: "note", id, text, tone };
}

function titleOf(key: TlxKey): string {
  return TLX_SCALES.find((scale) => scale.key === key)!.title;
}
