// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** One participant's way through the study: tasks timed, answers kept, scores computed, all of it told as events. */

import { CONDITION_TITLES, orderOf, TASKS, type Condition, type Task } from "./design";
import type { EventName, StudyLog } from "./events";
import { SUS_ITEMS, SUS_MIDDLE, susScore } from "./sus";
import { rawTlx, TLX_PAIRS, TLX_SCALES, tlxWeights, weightedTlx, type TlxKey, type TlxRatings } from "./tlx";

export type Step = "idle" | "task" | "working" | "sus" | "tlx" | "pairs" | "done";

export interface RunPort {
  now(): number;
  /** Switches the optimiser for a condition. */
  use(condition: Condition): void;
  /** Remembers how the optimiser is set; what it returns sets it so again. */
  remember(): () => void;
}

export interface Scores {
  readonly condition: Condition;
  readonly sus: number;
  readonly rawTlx: number;
  readonly weightedTlx: number;
  readonly taskS: readonly number[];
}

export class StudyRun {
  step: Step = "idle";
  participant = 1;
  /** Index of the item, scale or comparison that is asked now. */
  question = 0;
  readonly scores: Scores[] = [];
  sus: (number | null)[] = [];
  ratings: Partial<Record<TlxKey, number>> = {};
  pairs: (TlxKey | null)[] = [];
  private conditionIndex = 0;
  private taskIndex = 0;
  private taskS: number[] = [];
  private begunMs = 0;
  private putBack: () => void = () => undefined;

  constructor(
    private readonly log: StudyLog,
    private readonly port: RunPort,
  ) {}

  get condition(): Condition {
    return orderOf(this.participant)[this.conditionIndex]!;
  }

  get conditionNumber(): number {
    return this.conditionIndex + 1;
  }

  get task(): Task {
    return TASKS[this.taskIndex]!;
  }

  get taskNumber(): number {
    return this.taskIndex + 1;
  }

  begin(participant: number): void {
    const order = orderOf(participant);
    this.participant = participant;
    this.conditionIndex = 0;
    this.scores.length = 0;
    this.putBack = this.port.remember();
    this.tell("participant", `Participant ${participant} begins`, { order: order.join(" ") });
    this.beginCondition();
  }

  beginTask(): void {
    if (this.step !== "task") return;
    this.begunMs = this.port.now();
    this.step = "working";
    this.tell("task", `Task ${this.task.id} begins`, { task: this.task.id, phase: "begin" });
  }

  /** Ends the task; `finished` is the participant's own word. */
  endTask(finished: boolean): void {
    if (this.step !== "working") return;
    const seconds = (this.port.now() - this.begunMs) / 1000;
    this.taskS.push(seconds);
    const values = { task: this.task.id, phase: finished ? "done" : "given_up", seconds: seconds.toFixed(3) };
    this.tell("task", `Task ${this.task.id} ends`, values);
    this.taskIndex++;
    if (this.taskIndex < TASKS.length) this.step = "task";
    else this.ask("sus");
  }

  answerSus(answer: number): void {
    this.sus[this.question] = answer;
    this.tell("answer", SUS_ITEMS[this.question]!, {
      instrument: "sus",
      item: String(this.question + 1),
      value: String(answer),
    });
  }

  rate(rating: number): void {
    const { key, title } = TLX_SCALES[this.question]!;
    this.ratings[key] = rating;
    this.tell("answer", title, { instrument: "tlx", item: key, value: String(rating) });
  }

  compare(key: TlxKey): void {
    this.pairs[this.question] = key;
    const pair = TLX_PAIRS[this.question]!;
    this.tell("answer", pair.join(" or "), { instrument: "tlx_pair", item: pair.join("-"), value: key });
  }

  /** Whether the question shown has its answer; an item of the SUS may be left out, as the instrument allows. */
  get answered(): boolean {
    if (this.step === "tlx") return this.ratings[TLX_SCALES[this.question]!.key] !== undefined;
    return this.step === "pairs" ? this.pairs[this.question] != null : true;
  }

  next(): void {
    if (!this.answered) return;
    if (this.step === "sus" && this.sus[this.question] == null) this.leaveOut();
    const count = { sus: SUS_ITEMS.length, tlx: TLX_SCALES.length, pairs: TLX_PAIRS.length }[
      this.step as "sus" | "tlx" | "pairs"
    ];
    if (count === undefined) return;
    if (this.question + 1 < count) this.question++;
    else if (this.step === "sus") this.ask("tlx");
    else if (this.step === "tlx") this.ask("pairs");
    else this.endCondition();
  }

  back(): void {
    this.question = Math.max(0, this.question - 1);
  }

  /** Ends the study before its end; what was recorded stays, and the optimiser is as it was before. */
  breakOff(): void {
    if (this.step === "idle" || this.step === "done") return;
    this.tell("end", "The study was broken off", { complete: "false" });
    this.step = "idle";
    this.putBack();
  }

  private leaveOut(): void {
    this.sus[this.question] = SUS_MIDDLE;
    const values = { instrument: "sus", item: String(this.question + 1), value: String(SUS_MIDDLE), left_out: "true" };
    this.tell("answer", SUS_ITEMS[this.question]!, values);
  }

  private beginCondition(): void {
    this.taskIndex = 0;
    this.taskS = [];
    this.sus = SUS_ITEMS.map(() => null);
    this.ratings = {};
    this.pairs = TLX_PAIRS.map(() => null);
    this.step = "task";
    this.port.use(this.condition);
    this.tell("condition", `${CONDITION_TITLES[this.condition]} begins`, { position: String(this.conditionNumber) });
  }

  private ask(step: "sus" | "tlx" | "pairs"): void {
    this.step = step;
    this.question = 0;
  }

  private endCondition(): void {
    const ratings = this.ratings as TlxRatings;
    const scores: Scores = {
      condition: this.condition,
      sus: susScore(this.sus),
      rawTlx: rawTlx(ratings),
      weightedTlx: weightedTlx(ratings, this.pairs),
      taskS: this.taskS,
    };
    this.scores.push(scores);
    const weights = Object.entries(tlxWeights(this.pairs)).map(([key, weight]) => [`weight_${key}`, String(weight)]);
    const values = {
      sus: String(scores.sus),
      tlx_raw: scores.rawTlx.toFixed(3),
      tlx_weighted: scores.weightedTlx.toFixed(3),
    };
    this.tell("score", `Scores of ${CONDITION_TITLES[this.condition]}`, { ...values, ...Object.fromEntries(weights) });
    this.conditionIndex++;
    if (this.conditionIndex < 2) {
      this.beginCondition();
      return;
    }
    this.conditionIndex = 1;
    this.step = "done";
    this.tell("end", "The study ends", { complete: "true" });
    this.putBack();
  }

  private tell(name: EventName, message: string, values: Record<string, string>): void {
    const whose = { participant: String(this.participant), condition: this.condition };
    this.log.add({ atMs: this.port.now(), name, message, values: { ...whose, ...values } });
  }
}
