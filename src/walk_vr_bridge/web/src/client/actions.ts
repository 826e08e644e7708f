// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Everything a user can ask for: the one place through which panel, desktop and headset change anything. */

import type { EditDesk } from "./desk";
import { change } from "./edits";
import type { Outcome } from "./outbox";
import { showValue, writeParameter } from "./parameters";
import { playbackTimeS } from "./playback";
import type { BuildingState, Parameter, ParameterValue, Quat, SelectionState, SettingsState, Vec3 } from "./state";
import type { Store } from "./store";
import type { Wire } from "./wire";

/** Floors differ by this much within a storey. */
const LEVEL_M = 0.3;

export const SEEK_TYPE = "std_msgs/Float64";

export class Actions {
  constructor(
    private readonly store: Store,
    private readonly desk: EditDesk,
    private readonly wire: Wire,
    private readonly namespace: () => string,
    private readonly now: () => number,
  ) {}

  grab(id: number): void {
    this.desk.grab(id);
    this.select(id);
  }

  /** May be called every frame; at most 90 a second are sent, the newest wins. */
  drag(id: number, position: Vec3, quat: Quat | null = null): void {
    this.desk.drag(id, position, quat);
  }

  release(id: number, position: Vec3, quat: Quat | null = null): Promise<Outcome> {
    return this.desk.release(id, position, quat);
  }

  cancel(id: number): void {
    this.desk.cancel(id);
  }

  holds(id: number): boolean {
    return this.desk.holds(id);
  }

  /** Puts a keypoint where the user dropped one: there, or at the best place around, as the settings say. */
  add(position: Vec3): Promise<Outcome> {
    return this.store.state.settings.addNear ? this.insertNear(position) : this.insert(position);
  }

  /** Puts a keypoint here: behind `after`, or where the tour grows least. */
  insert(position: Vec3, after: number | null = null): Promise<Outcome> {
    return this.added(change("insert", after, { position }));
  }

  insertHalfWay(after: number): Promise<Outcome> {
    return this.added(change("insert", after, { argument: "half-way" }));
  }

  /** Puts a keypoint at the best place around. */
  insertNear(position: Vec3): Promise<Outcome> {
    return this.added(change("insertNear", null, { position }));
  }

  remove(id: number): Promise<Outcome> {
    if (this.store.state.selection.keypoint === id) this.select(null);
    return this.desk.perform(change("remove", id));
  }

  reorder(id: number, where: "first" | "last" | "earlier" | "later" | number): Promise<Outcome> {
    return this.desk.perform(change("reorder", id, { argument: String(where) }));
  }

  lock(id: number): Promise<Outcome> {
    return this.desk.perform(change("lock", id));
  }

  unlock(id: number): Promise<Outcome> {
    return this.desk.perform(change("unlock", id));
  }

  setStart(id: number): Promise<Outcome> {
    return this.desk.perform(change("start", id));
  }

  setEnd(id: number): Promise<Outcome> {
    return this.desk.perform(change("end", id));
  }

  freeEnd(id: number): Promise<Outcome> {
    return this.desk.perform(change("freeEnd", id));
  }

  /** How long the walker stands here; null: as the timing says. */
  dwell(id: number, seconds: number | null): Promise<Outcome> {
    return this.desk.perform(change("dwell", id, { argument: seconds === null ? "" : String(seconds) }));
  }

  lookAt(id: number, target: Vec3 | null): Promise<Outcome> {
    return this.desk.perform(change("lookAt", id, { lookAt: target }));
  }

  undo(): Promise<Outcome> {
    return this.desk.perform(change("undo", null));
  }

  redo(): Promise<Outcome> {
    return this.desk.perform(change("redo", null));
  }

  /** Looks for a better order now. Resolves with whether it was done. */
  replan(): Promise<boolean> {
    return this.ask("replan", {}, "The order was not changed");
  }

  /** Resolves with whether the parameter was taken; a refusal is shown. */
  async setParameter(parameter: Parameter, value: ParameterValue): Promise<boolean> {
    showValue(this.store, parameter.name, value);
    const refused = await writeParameter(this.wire, this.namespace(), parameter, value).catch(String);
    if (!refused) return true;
    showValue(this.store, parameter.name, parameter.value);
    this.desk.refuse(null, null, refused);
    return false;
  }

  play(): Promise<boolean> {
    return this.ask("play", { data: true }, "It does not play");
  }

  pause(): Promise<boolean> {
    return this.ask("play", { data: false }, "It does not pause");
  }

  async stop(): Promise<void> {
    await this.pause();
    this.seek(0);
  }

  seek(timeS: number): void {
    this.wire.publish(`${this.namespace()}/playback/seek`, { data: timeS });
    this.store.set("playback", { ...this.store.state.playback, timeS, atMs: this.now() });
  }

  speed(factor: number): void {
    this.wire.publish(`${this.namespace()}/playback/speed`, { data: factor });
    const { playback } = this.store.state;
    const timeS = playbackTimeS(playback, this.now());
    this.store.set("playback", { ...playback, timeS, atMs: this.now(), speed: factor });
  }

  select(id: number | null): void {
    if (this.store.state.selection.keypoint !== id) this.store.patch("selection", { keypoint: id });
  }

  /** Chooses a keypoint and, where one storey is shown, shows its own. */
  reveal(id: number): void {
    const { building, keypoints, selection } = this.store.state;
    const position = keypoints.find((keypoint) => keypoint.id === id)?.position;
    if (building && position && selection.storey >= 0) this.showStorey(storeyOf(building, position[2]));
    this.select(id);
  }

  showStorey(storey: number): void {
    this.store.patch("selection", { storey });
  }

  useTool(tool: SelectionState["tool"]): void {
    this.store.patch("selection", { tool });
  }

  set(settings: Partial<SettingsState>): void {
    this.store.patch("settings", settings);
  }

  dismissRefusal(serial: number): void {
    this.store.set(
      "refusals",
      this.store.state.refusals.filter((refusal) => refusal.serial !== serial),
    );
  }

  private async added(edit: ReturnType<typeof change>): Promise<Outcome> {
    const outcome = await this.desk.perform(edit);
    if (outcome.outcome === "accepted" && outcome.keypoint !== null) this.select(outcome.keypoint);
    return outcome;
  }

  private async ask(service: string, args: unknown, otherwise: string): Promise<boolean> {
    try {
      const answer = (await this.wire.call(`${this.namespace()}/${service}`, args)) as Partial<Trigger> | null;
      if (answer?.success === true) return true;
      this.desk.refuse(null, null, `${otherwise}: ${answer?.message || "no reason given"}`);
    } catch (error) {
      this.desk.refuse(null, null, `${otherwise}: ${error instanceof Error ? error.message : String(error)}`);
    }
    return false;
  }
}

/** Index of the storey that a walker with the eye at this height is on. */
export function storeyOf({ storeys, walker }: BuildingState, eyeZ: number): number {
  const above = storeys.findIndex(({ floorZ }) => floorZ > eyeZ - walker.eyeHeightM + LEVEL_M);
  return Math.max(0, above < 0 ? storeys.length - 1 : above - 1);
}

interface Trigger {
  readonly success: boolean;
  readonly message: string;
}
