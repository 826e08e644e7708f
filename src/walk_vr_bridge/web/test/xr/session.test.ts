// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { askForFrames } from "../../src/xr/session";

function session(frameRate: number | undefined, rates: number[] | undefined, answer = Promise.resolve()) {
  const supportedFrameRates = rates && Float32Array.from(rates);
  return { frameRate, supportedFrameRates, updateTargetFrameRate: vi.fn(() => answer) };
}

describe("the frame rate", () => {
  it("is the highest up to the one that the page is made for", () => {
    const asked = session(72, [72, 80, 90, 120]);
    askForFrames(asked);
    expect(asked.updateTargetFrameRate).toHaveBeenCalledExactlyOnceWith(90);
    const slow = session(60, [60, 72, 120]);
    askForFrames(slow);
    expect(slow.updateTargetFrameRate).toHaveBeenCalledExactlyOnceWith(72);
  });

  it("is left alone where it is right, where nothing fits and where nobody can be asked", () => {
    for (const kept of [session(90, [72, 90]), session(144, [120, 144]), session(72, undefined), session(undefined, [])]) {
      askForFrames(kept);
      expect(kept.updateTargetFrameRate).not.toHaveBeenCalled();
    }
  });

  it("stays what it is where the headset refuses", async () => {
    const refused = Promise.reject(new Error("low battery"));
    askForFrames(session(72, [72, 90], refused as Promise<void>));
    await expect(refused).rejects.toThrow();
  });
});
