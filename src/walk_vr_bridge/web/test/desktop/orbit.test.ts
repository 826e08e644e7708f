// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { distanceFor } from "../../src/desktop/orbit";

describe("the distance from which all of a box is seen", () => {
  it("brings a corner right to the edge of what is free, by the camera's own projection", () => {
    for (const [half, polar, azimuth] of [
      [[12, 1, 8], 0.75, -0.65],
      [[30, 4, 2], 1.2, 0.3],
      [[1, 6, 1], 0.4, 2.5],
    ] as const) {
      const back = new Vector3().setFromSphericalCoords(1, polar, azimuth);
      const [tanX, tanY] = [0.5, 0.4];
      const camera = new PerspectiveCamera((2 * Math.atan(tanY) * 180) / Math.PI, tanX / tanY, 0.01, 1000);
      camera.position.copy(back).multiplyScalar(distanceFor(half, back, tanX, tanY));
      camera.lookAt(0, 0, 0);
      camera.updateMatrixWorld();
      let outermost = 0;
      for (let corner = 0; corner < 8; corner++) {
        const at = new Vector3(...half.map((side, axis) => (corner & (1 << axis) ? side : -side))).project(camera);
        outermost = Math.max(outermost, Math.abs(at.x), Math.abs(at.y));
      }
      expect(outermost).toBeCloseTo(1, 6);
    }
  });
});
