// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A nav_msgs/Path out of its CDR bytes, into buffers that are used again: drawing a path allocates nothing. */

import { fields, MessageError, stampText } from "./check";
import type { PathState, TourState } from "./state";

const HEADER = 24;
const STRIDE = 72;
/** From a row's begin to its doubles, in rows behind the first; the first row is four bytes shorter. */
const DOUBLES = 16;
const FRAME_MAP = 0x0070616d;
const MAX_ROWS = 1_000_000;
/** A quaternion is a unit one to this. */
const UNIT = 1e-3;

/** Returns the CDR bytes of a `cbor-raw` message. */
export function rawBytes(message: unknown): DataView {
  const { bytes } = fields(message, "raw message");
  if (!(bytes instanceof Uint8Array)) throw new MessageError("a raw message carries bytes");
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}

function rows(view: DataView): number {
  if (view.byteLength < HEADER || view.getUint32(0) !== 0x00010000) throw new MessageError("no little-endian CDR");
  if (view.getUint32(16, true) !== FRAME_MAP) throw new MessageError("a path is in the frame map");
  const count = view.getUint32(20, true);
  if (count > MAX_ROWS || (count > 0 && view.byteLength < HEADER + 4 + STRIDE * count)) {
    throw new MessageError(`a path of ${count} poses does not fit ${view.byteLength} bytes`);
  }
  return count;
}

function revisionOf(view: DataView): string {
  return stampText(view.getInt32(4, true), view.getUint32(8, true));
}

/** A buffer for `count` numbers: the old one where it is large enough. */
function room(buffer: Float32Array, count: number): Float32Array {
  return buffer.length >= count ? buffer : new Float32Array(Math.ceil(count * 1.5));
}

/** Reads a path. @throws MessageError, with `into` half overwritten but its count at 0: it then shows no path. */
export function readPath(view: DataView, into: PathState): void {
  const count = rows(view);
  into.count = 0;
  const positions = room(into.positions, 3 * count);
  const quats = room(into.quats, 4 * count);
  const timeS = room(into.timeS, count);
  const sec0 = view.getInt32(4, true);
  const nanosec0 = view.getUint32(8, true);
  for (let row = 0; row < count; row++) {
    const at = HEADER + 4 + STRIDE * row;
    const stampAt = row === 0 ? HEADER : at;
    timeS[row] = view.getInt32(stampAt, true) - sec0 + (view.getUint32(stampAt + 4, true) - nanosec0) * 1e-9;
    readDoubles(view, at + DOUBLES, positions, 3 * row, 3);
    readDoubles(view, at + DOUBLES + 24, quats, 4 * row, 4);
    checkRow(positions, quats, timeS, row);
  }
  into.count = count;
  into.positions = positions;
  into.quats = quats;
  into.timeS = timeS;
  into.revision = revisionOf(view);
  into.speedMps = room(into.speedMps, count);
  into.heightM = room(into.heightM, count).fill(NaN);
  into.clearanceM = room(into.clearanceM, count).fill(NaN);
  into.durationS = count > 0 ? timeS[count - 1]! : 0;
  measure(into);
}

export function readTour(view: DataView, into: TourState): void {
  const count = rows(view);
  const positions = room(into.positions, 3 * count);
  for (let row = 0; row < count; row++) readDoubles(view, HEADER + 4 + STRIDE * row + DOUBLES, positions, 3 * row, 3);
  for (let index = 0; index < 3 * count; index++) {
    if (!Number.isFinite(positions[index])) throw new MessageError("a tour with a place that is not finite");
  }
  Object.assign(into, { count, positions, revision: revisionOf(view) });
}

function readDoubles(view: DataView, at: number, into: Float32Array, index: number, count: number): void {
  for (let k = 0; k < count; k++) into[index + k] = view.getFloat64(at + 8 * k, true);
}

function checkRow(positions: Float32Array, quats: Float32Array, timeS: Float32Array, row: number): void {
  const sum = positions[3 * row]! + positions[3 * row + 1]! + positions[3 * row + 2]!;
  if (!Number.isFinite(sum)) throw new MessageError(`pose ${row} of a path is not finite`);
  let square = 0;
  for (let k = 0; k < 4; k++) square += quats[4 * row + k]! ** 2;
  if (!(Math.abs(square - 1) < 2 * UNIT)) throw new MessageError(`pose ${row} of a path has no unit quaternion`);
  if (row > 0 && timeS[row]! < timeS[row - 1]!) throw new MessageError(`the times of a path fall at pose ${row}`);
}

/** Fills in the speed, by differences over the neighbours, and the length. */
function measure(path: PathState): void {
  const { count, positions, timeS, speedMps } = path;
  let length = 0;
  let before = 0;
  for (let row = 0; row < count; row++) {
    const step = row + 1 < count ? distance(positions, row, row + 1) : 0;
    const wait = row > 0 ? timeS[row]! - timeS[row - 1]! : 0;
    const next = row + 1 < count ? timeS[row + 1]! - timeS[row]! : 0;
    speedMps[row] = wait + next > 0 ? (before + step) / (wait + next) : 0;
    length += step;
    before = step;
  }
  path.lengthM = length;
}

function distance(positions: Float32Array, a: number, b: number): number {
  const dx = positions[3 * b]! - positions[3 * a]!;
  const dy = positions[3 * b + 1]! - positions[3 * a + 1]!;
  const dz = positions[3 * b + 2]! - positions[3 * a + 2]!;
  return Math.sqrt(dx * dx + dy * dy + dz * dz);
}
