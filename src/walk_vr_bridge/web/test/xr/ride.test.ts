// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { vignetteFor } from "../../src/xr/comfort";
import { BACK_MPS, Ride, wrapAngle } from "../../src/xr/ride";
import { MAX_CRUMBS, Trail } from "../../src/xr/trail";

const stand = (x = 0, y = 0, z = 0, heading = 0) => ({ x, y, z, heading });
const FRAME_S = 1 / 90;

describe("the ride", () => {
  it("follows the tour with its speed and turn, the shorter way round", () => {
    const ride = new Ride();
    ride.begin();
    const now = stand(0, 0, 0, 3);
    ride.follow(now, stand(1.4 * FRAME_S, 0, 0, -3), FRAME_S);
    expect(ride.leapt).toBe(false);
    expect(ride.speed).toBeCloseTo(1.4, 6);
    expect(ride.turnRate * FRAME_S).toBeCloseTo(2 * Math.PI - 6, 6);
    expect(wrapAngle(now.heading + 3)).toBeCloseTo(0, 6);
  });

  it("tells a leap, which is hidden and makes no speed", () => {
    const ride = new Ride();
    ride.begin();
    const now = stand();
    ride.follow(now, stand(5, 0, 0), FRAME_S);
    expect([ride.leapt, ride.speed, now.x]).toEqual([true, 0, 5]);
  });

  it("leads back at a walk along the way that was strayed, to where the tour was left", () => {
    const ride = new Ride();
    ride.begin();
    ride.stray(12.5, stand());
    const now = stand();
    // Round a corner: 3 m along x, then 2 m along y.
    for (let i = 0; i <= 60; i++) {
      now.x = Math.min(3, i / 12);
      now.y = Math.max(0, i / 12 - 3);
      ride.wander(now.x, now.y, 0);
    }
    ride.leadBack();
    let [seconds, farthest] = [0, 0];
    const before = stand();
    for (;;) {
      Object.assign(before, now);
      const there = ride.walkBack(now, FRAME_S);
      seconds += FRAME_S;
      expect(Math.hypot(now.x - before.x, now.y - before.y)).toBeLessThan(BACK_MPS * FRAME_S * 1.02);
      // Never through the corner: always near one of the two legs.
      farthest = Math.max(farthest, Math.min(Math.abs(now.y), Math.abs(now.x - 3)));
      if (there) break;
      expect(seconds).toBeLessThan(10);
    }
    expect(Math.hypot(now.x, now.y)).toBeLessThan(1e-6);
    expect(seconds).toBeCloseTo(5 / BACK_MPS, 1);
    expect(farthest).toBeLessThan(0.1);
    expect([ride.phase, ride.leftAtS]).toEqual(["on", 12.5]);
  });

  it("jumps back where one had jumped away", () => {
    const ride = new Ride();
    ride.begin();
    ride.stray(1, stand());
    ride.wander(20, 0, 3);
    ride.leadBack();
    const now = stand(20, 0, 3);
    let leaps = 0;
    for (let i = 0; i < 9 && ride.phase === "back"; i++) {
      ride.walkBack(now, FRAME_S);
      if (ride.leapt) leaps += 1;
    }
    expect([leaps, now.x, now.z, ride.phase]).toEqual([1, 0, 0, "on"]);
  });

  it("darkens the rim with speed and turning, never at rest", () => {
    expect(vignetteFor(0, 0)).toBe(0);
    expect(vignetteFor(1.4, 0)).toBeGreaterThan(vignetteFor(0.7, 0));
    expect(vignetteFor(0, 1)).toBeGreaterThan(0.3);
    expect(vignetteFor(9, 9)).toBe(1);
  });
});

describe("the trail", () => {
  it("cuts loops off", () => {
    const trail = new Trail();
    for (let i = 0; i <= 40; i++) trail.drop(Math.cos((i * Math.PI) / 20) * 2, Math.sin((i * Math.PI) / 20) * 2, 0);
    expect(trail.count).toBe(1);
  });

  it("keeps its beginning however long it gets", () => {
    const trail = new Trail();
    for (let i = 0; i < 3000; i++) trail.drop(i, 0, 0);
    expect(trail.count).toBeLessThanOrEqual(MAX_CRUMBS);
    expect(trail.x(0)).toBe(0);
    expect(trail.x(trail.count - 1)).toBe(2999);
    for (let i = 1; i < trail.count; i++) expect(trail.x(i)).toBeGreaterThan(trail.x(i - 1));
  });
});
