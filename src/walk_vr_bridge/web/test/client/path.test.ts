// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { readPath } from "../../src/client/path";
import { pathPoint, playbackTimeS, rowAt, samplePath } from "../../src/client/playback";
import { emptyPath } from "../../src/client/store";
import { pathBytes, type Row } from "./path_bytes";

const WALK: Row[] = [0, 1, 2, 3].map((t) => ({ t, p: [2 * t, 0, 1.6] }));

describe("path", () => {
  it("reads what CDR holds", () => {
    const path = emptyPath();
    readPath(pathBytes(WALK), path);
    expect(path.count).toBe(4);
    expect(path.revision).toBe("1700000000900000000");
    expect(Array.from(path.positions.subarray(0, 12))).toEqual(
      [0, 0, 1.6, 2, 0, 1.6, 4, 0, 1.6, 6, 0, 1.6].map(Math.fround),
    );
    expect(Array.from(path.timeS.subarray(0, 4))).toEqual([0, 1, 2, 3]);
    expect(Array.from(path.speedMps.subarray(0, 4))).toEqual([2, 2, 2, 2]);
    expect([path.lengthM, path.durationS]).toEqual([6, 3]);
  });

  it("keeps its buffers for a path that fits, and shows none where there is none", () => {
    const path = emptyPath();
    readPath(pathBytes(WALK), path);
    const { positions } = path;
    readPath(pathBytes(WALK.slice(0, 2)), path);
    expect(path.positions).toBe(positions);
    expect(path.count).toBe(2);
    readPath(pathBytes([]), path);
    expect([path.count, path.lengthM, path.durationS]).toEqual([0, 0, 0]);
  });

  it.each([
    ["not finite", [{ t: 0, p: [NaN, 0, 0] }]],
    ["unit quaternion", [{ t: 0, p: [0, 0, 0], q: [0, 0, 0, 2] }]],
    ["times of a path fall", [WALK[1]!, WALK[0]!]],
  ] as [string, Row[]][])("refuses one that is %s, and shows nothing of it", (reason, rows) => {
    const path = emptyPath();
    expect(() => readPath(pathBytes(rows), path)).toThrow(reason);
    expect(path.count).toBe(0);
  });

  it("refuses one that is cut short or claims too much", () => {
    const whole = pathBytes(WALK);
    expect(() => readPath(new DataView(whole.buffer, 0, whole.byteLength - 8), emptyPath())).toThrow("does not fit");
    expect(() => readPath(new DataView(new ArrayBuffer(8)), emptyPath())).toThrow("CDR");
    whole.setUint32(20, 4_000_000_000, true);
    expect(() => readPath(whole, emptyPath())).toThrow("does not fit");
  });
});

describe("playback", () => {
  it("is on the path at each time, and at its ends beyond", () => {
    const path = emptyPath();
    const half = Math.SQRT1_2;
    readPath(pathBytes([WALK[0]!, { ...WALK[1]!, q: [0, 0, half, half] }, WALK[2]!, WALK[3]!]), path);
    const out = pathPoint();
    const at = (t: number): number => {
      expect(samplePath(path, t, out)).toBe(true);
      return out.position[0]!;
    };
    expect([at(-1), at(0), at(0.5), at(2.25), at(9)]).toEqual([0, 0, 1, 4.5, 6]);
    at(0.5);
    expect(2 * Math.atan2(out.quat[2]!, out.quat[3]!)).toBeCloseTo(Math.PI / 4, 6);
    expect(rowAt(path, 2)).toBe(2);
    expect(samplePath(emptyPath(), 1, out)).toBe(false);
  });

  it("goes on by the clock between the server's words, within the walk", () => {
    const playback = { playing: true, timeS: 10, atMs: 1000, speed: 2, durationS: 13 };
    expect([1000, 2000, 9000].map((now) => playbackTimeS(playback, now))).toEqual([10, 12, 13]);
    expect(playbackTimeS({ ...playback, speed: -4 }, 9000)).toBe(0);
    expect(playbackTimeS({ ...playback, playing: false }, 9000)).toBe(10);
  });
});
