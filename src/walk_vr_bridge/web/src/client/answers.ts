// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What the bridge and the planner answer and announce, read from their messages. */

import { atLeast, fields, finite, flag, list, MessageError, words } from "./check";
import type { NodeStatus, PlaybackState } from "./state";

export interface EditResult {
  readonly outcome: "accepted" | "followed" | "refused";
  /** Identity of the keypoint meant, or of the new one; null where none. */
  readonly keypoint: number | null;
  readonly revision: string;
  /** The label of the edit answered. */
  readonly label: number;
  /** Why it was refused. */
  readonly reason: string;
  readonly betterOrderSavesM: number | null;
}

/** Returns a message of `edit_results`. @throws MessageError where it is not sound. */
export function editResult(message: unknown): EditResult {
  const status = fields(message, "edit_results");
  const values = keyValues(status.values);
  const outcome = values.get("outcome");
  if (outcome !== "accepted" && outcome !== "followed" && outcome !== "refused") {
    throw new MessageError(`an edit's outcome is accepted, followed or refused, not ${outcome ?? "missing"}`);
  }
  const saves = Number(values.get("better_order_saves_m") ?? NaN);
  return {
    outcome,
    keypoint: /^\d+$/.test(values.get("keypoint") ?? "") ? Number(values.get("keypoint")) : null,
    revision: digits(values.get("revision_ns") ?? "0"),
    label: Number(digits(values.get("edit_stamp_ns") ?? "0")),
    reason: outcome === "refused" ? words(status.message, "reason") : "",
    betterOrderSavesM: Number.isFinite(saves) ? saves : null,
  };
}

function keyValues(value: unknown): Map<string, string> {
  const pairs = list(value, "values").map((one) => fields(one, "value"));
  return new Map(pairs.map((pair) => [words(pair.key, "key"), words(pair.value, "value")]));
}

function digits(value: unknown): string {
  const revision = words(value, "revision");
  if (!/^\d*$/.test(revision)) throw new MessageError(`a revision is decimal digits, not "${revision.slice(0, 40)}"`);
  return revision;
}

/** Returns the object that the text of a std_msgs/String holds. */
function told(message: unknown, where: string): Readonly<Record<string, unknown>> {
  const { data } = fields(message, where);
  let value: unknown;
  try {
    value = JSON.parse(words(data, where));
  } catch (error) {
    throw new MessageError(`${where} is no JSON: ${String(error)}`);
  }
  return fields(value, where);
}

export function playbackState(message: unknown, nowMs: number): PlaybackState {
  const said = told(message, "playback");
  return {
    playing: flag(said.playing, "playing"),
    timeS: finite(said.t_s, "t_s"),
    atMs: nowMs,
    speed: finite(said.speed, "speed"),
    durationS: finite(said.duration_s, "duration_s"),
  };
}

export interface Files {
  readonly building: string;
  readonly buildingEtag: string;
  readonly miniatureEtag: string;
  readonly importance: string;
}

export function files(message: unknown): Files {
  const said = told(message, "bridge/files");
  return {
    building: words(said.building, "building"),
    buildingEtag: words(said.building_etag, "building_etag"),
    miniatureEtag: words(said.miniature_etag, "miniature_etag"),
    importance: digits(said.importance_ns),
  };
}

export function session(message: unknown): { clientId: string; role: "viewer" | "editor" } {
  const said = told(message, "bridge/session");
  if (said.role !== "viewer" && said.role !== "editor") throw new MessageError("a role is viewer or editor");
  return { clientId: words(said.client_id, "client_id"), role: said.role };
}

const LEVELS = ["ok", "warn", "error", "error"] as const;

/** Returns what the nodes say of themselves. */
export function nodeStatuses(message: unknown): NodeStatus[] {
  return list(fields(message, "diagnostics").status, "status").map((one) => {
    const status = fields(one, "status");
    const level = LEVELS[finite(status.level, "level")] ?? "error";
    return { node: words(status.name, "name"), level, message: words(status.message, "message") };
  });
}

/** Puts newer statuses in the place of older ones of the same node. */
export function mergeStatuses(old: readonly NodeStatus[], news: readonly NodeStatus[]): readonly NodeStatus[] {
  const changed = news.filter(({ node, level, message }) => {
    const before = old.find((one) => one.node === node);
    return before?.level !== level || before.message !== message;
  });
  if (changed.length === 0) return old;
  return [...old.filter(({ node }) => !changed.some((one) => one.node === node)), ...changed];
}

/** Whether what was accepted at `revision` is in what is shown at `shown`. */
export function includes(shown: string, revision: string): boolean {
  return shown !== "" && atLeast(shown, revision);
}
