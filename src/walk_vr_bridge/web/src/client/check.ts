// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What a message has to be before it is used; each check returns the value with its type, or throws a MessageError. */

import type { Quat, Vec3 } from "./state";

export class MessageError extends Error {
  override readonly name = "MessageError";
}

export type Fields = Readonly<Record<string, unknown>>;

function fail(where: string, wanted: string, value: unknown): never {
  throw new MessageError(`${where} is ${wanted}, not ${JSON.stringify(value)?.slice(0, 80) ?? "missing"}`);
}

export function fields(value: unknown, where: string): Fields {
  if (typeof value !== "object" || value === null || Array.isArray(value)) fail(where, "an object", value);
  return value as Fields;
}

export function list(value: unknown, where: string): readonly unknown[] {
  // Arrays of numbers arrive as typed arrays where the message is CBOR.
  if (ArrayBuffer.isView(value) && !(value instanceof DataView)) return Array.from(value as unknown as number[]);
  if (!Array.isArray(value)) fail(where, "a list", value);
  return value as readonly unknown[];
}

export function finite(value: unknown, where: string): number {
  if (typeof value !== "number" || !Number.isFinite(value)) fail(where, "a finite number", value);
  return value as number;
}

export function whole(value: unknown, where: string): number {
  if (!Number.isInteger(value)) fail(where, "a whole number", value);
  return value as number;
}

export function words(value: unknown, where: string): string {
  if (typeof value !== "string") fail(where, "a text", value);
  return value as string;
}

export function flag(value: unknown, where: string): boolean {
  if (typeof value !== "boolean") fail(where, "true or false", value);
  return value as boolean;
}

/** A point as ROS writes it: {x, y, z}. */
export function point(value: unknown, where: string): Vec3 {
  const { x, y, z } = fields(value, where);
  return [finite(x, `${where}.x`), finite(y, `${where}.y`), finite(z, `${where}.z`)];
}

/** A point as our own JSON writes it: [x, y, z]. */
export function triple(value: unknown, where: string): Vec3 {
  const numbers = list(value, where).map((number) => finite(number, where));
  if (numbers.length !== 3) fail(where, "three numbers", value);
  return numbers as unknown as Vec3;
}

export function unitQuat(value: unknown, where: string): Quat {
  const { x, y, z, w } = fields(value, where);
  const quat: Quat = [finite(x, where), finite(y, where), finite(z, where), finite(w, where)];
  if (Math.abs(Math.hypot(...quat) - 1) > 1e-3) fail(where, "a unit quaternion", value);
  return quat;
}

/** A ROS stamp {sec, nanosec} in nanoseconds, as text. */
export function stamp(value: unknown, where: string): string {
  const { sec, nanosec } = fields(value, where);
  return stampText(whole(sec, `${where}.sec`), whole(nanosec, `${where}.nanosec`));
}

export function stampText(sec: number, nanosec: number): string {
  return String(BigInt(sec) * 1_000_000_000n + BigInt(nanosec));
}

/** Whether revision `a` is at least as new as `b`; both are decimal digits. */
export function atLeast(a: string, b: string): boolean {
  return a.length === b.length ? a >= b : a.length > b.length;
}
