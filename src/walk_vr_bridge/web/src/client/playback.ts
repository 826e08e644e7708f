// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Where the walker is at a time. */

import type { PathState, PlaybackState } from "./state";

/** Returns the time of playback at this moment [s]: the server says it twice a second, the clock goes on between. */
export function playbackTimeS(playback: PlaybackState, nowMs: number): number {
  if (!playback.playing) return playback.timeS;
  const timeS = playback.timeS + (playback.speed * (nowMs - playback.atMs)) / 1000;
  return Math.min(playback.durationS, Math.max(0, timeS));
}

export interface PathPoint {
  readonly position: Float32Array;
  readonly quat: Float32Array;
  speedMps: number;
  row: number;
}

export function pathPoint(): PathPoint {
  return { position: new Float32Array(3), quat: new Float32Array([0, 0, 0, 1]), speedMps: 0, row: 0 };
}

/** Writes where the walker is at `timeS` into `out`; false where there is no path. Allocates nothing. */
export function samplePath(path: PathState, timeS: number, out: PathPoint): boolean {
  const { count, positions, quats } = path;
  if (count === 0) return false;
  const row = rowAt(path, timeS);
  const next = Math.min(row + 1, count - 1);
  const span = path.timeS[next]! - path.timeS[row]!;
  const share = span > 0 ? Math.min(1, Math.max(0, (timeS - path.timeS[row]!) / span)) : 0;
  for (let k = 0; k < 3; k++) out.position[k] = mix(positions[3 * row + k]!, positions[3 * next + k]!, share);
  mixQuats(quats, 4 * row, 4 * next, share, out.quat);
  out.speedMps = mix(path.speedMps[row]!, path.speedMps[next]!, share);
  out.row = row;
  return true;
}

/** The last row that is not later than `timeS`. */
export function rowAt(path: PathState, timeS: number): number {
  let low = 0;
  let high = path.count - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (path.timeS[middle]! <= timeS) low = middle;
    else high = middle - 1;
  }
  return low;
}

function mix(a: number, b: number, share: number): number {
  return a + (b - a) * share;
}

/** Normalised linear blend; neighbours on a path differ by a few degrees. */
function mixQuats(quats: Float32Array, a: number, b: number, share: number, out: Float32Array): void {
  let dot = 0;
  for (let k = 0; k < 4; k++) dot += quats[a + k]! * quats[b + k]!;
  const sign = dot < 0 ? -1 : 1;
  let square = 0;
  for (let k = 0; k < 4; k++) {
    out[k] = mix(quats[a + k]!, sign * quats[b + k]!, share);
    square += out[k]! ** 2;
  }
  const scale = 1 / Math.sqrt(square);
  for (let k = 0; k < 4; k++) out[k]! *= scale;
}
