// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A decoder for the part of CBOR (RFC 8949, RFC 8746) that the bridge sends: no streaming, text keys only. */

export class CborError extends Error {
  override readonly name = "CborError";
}

const text = new TextDecoder("utf-8", { fatal: true });
const MAX_DEPTH = 32;

/** Little-endian typed arrays by tag; a copy is made, as the bytes in the message are seldom aligned. */
const TYPED_ARRAYS: Readonly<Record<number, (bytes: ArrayBuffer) => ArrayBufferView>> = {
  64: (bytes) => new Uint8Array(bytes),
  69: (bytes) => new Uint16Array(bytes),
  70: (bytes) => new Uint32Array(bytes),
  72: (bytes) => new Int8Array(bytes),
  77: (bytes) => new Int16Array(bytes),
  78: (bytes) => new Int32Array(bytes),
  85: (bytes) => new Float32Array(bytes),
  86: (bytes) => new Float64Array(bytes),
};

interface Cursor {
  readonly view: DataView;
  readonly bytes: Uint8Array;
  at: number;
}

/** Returns the one value that the buffer holds. Byte strings are views into it. @throws CborError, or RangeError. */
export function decodeCbor(buffer: ArrayBuffer): unknown {
  const cursor: Cursor = { view: new DataView(buffer), bytes: new Uint8Array(buffer), at: 0 };
  const value = item(cursor, 0);
  if (cursor.at !== buffer.byteLength) throw new CborError(`${buffer.byteLength - cursor.at} bytes too many`);
  return value;
}

function item(cursor: Cursor, depth: number): unknown {
  if (depth > MAX_DEPTH) throw new CborError("nested too deeply");
  const head = cursor.view.getUint8(cursor.at++);
  const major = head >> 5;
  const info = head & 31;
  if (major === 7) return simple(cursor, info);
  const count = argument(cursor, info);
  switch (major) {
    case 0:
      return count;
    case 1:
      return -1 - count;
    case 2:
      return take(cursor, count);
    case 3:
      return text.decode(take(cursor, count));
    case 4:
      return array(cursor, count, depth);
    case 5:
      return map(cursor, count, depth);
    default:
      return tagged(cursor, count, depth);
  }
}

function argument(cursor: Cursor, info: number): number {
  const { view } = cursor;
  const at = cursor.at;
  if (info < 24) return info;
  if (info === 24) return (cursor.at += 1), view.getUint8(at);
  if (info === 25) return (cursor.at += 2), view.getUint16(at);
  if (info === 26) return (cursor.at += 4), view.getUint32(at);
  if (info === 27) return (cursor.at += 8), Number(view.getBigUint64(at));
  throw new CborError(`length code ${info} is not taken`);
}

function simple(cursor: Cursor, info: number): unknown {
  const { view } = cursor;
  const at = cursor.at;
  if (info === 20) return false;
  if (info === 21) return true;
  if (info === 22) return null;
  if (info === 23) return undefined;
  if (info === 25) return (cursor.at += 2), half(view.getUint16(at));
  if (info === 26) return (cursor.at += 4), view.getFloat32(at);
  if (info === 27) return (cursor.at += 8), view.getFloat64(at);
  throw new CborError(`simple value ${info} is not taken`);
}

function half(bits: number): number {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

function take(cursor: Cursor, count: number): Uint8Array {
  const end = cursor.at + count;
  if (end > cursor.bytes.length) throw new CborError("cut short");
  const bytes = cursor.bytes.subarray(cursor.at, end);
  cursor.at = end;
  return bytes;
}

function array(cursor: Cursor, count: number, depth: number): unknown[] {
  // A length is a claim: each item takes a byte at least, so a lie cannot make the array large.
  if (count > cursor.bytes.length - cursor.at) throw new CborError("cut short");
  const values: unknown[] = [];
  for (let index = 0; index < count; index++) values.push(item(cursor, depth + 1));
  return values;
}

function map(cursor: Cursor, count: number, depth: number): Record<string, unknown> {
  if (count > cursor.bytes.length - cursor.at) throw new CborError("cut short");
  const values = Object.create(null) as Record<string, unknown>;
  for (let index = 0; index < count; index++) {
    const key = item(cursor, depth + 1);
    if (typeof key !== "string") throw new CborError("a key that is no text");
    values[key] = item(cursor, depth + 1);
  }
  return values;
}

function tagged(cursor: Cursor, tag: number, depth: number): unknown {
  const value = item(cursor, depth + 1);
  const make = TYPED_ARRAYS[tag];
  if (!make) return value;
  if (!(value instanceof Uint8Array)) throw new CborError(`tag ${tag} without bytes`);
  return make(value.slice().buffer);
}
