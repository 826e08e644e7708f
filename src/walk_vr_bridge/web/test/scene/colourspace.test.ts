// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { ShaderChunk } from "three";
import { describe, expect, it } from "vitest";
import { ROOTS, STRAIGHT, useFastColours } from "../../src/scene/colourspace";

describe("colours by roots", () => {
  it("are those of sRGB to a fifth of a step of 255", () => {
    const [half, quarter, whole, one] = ROOTS;
    for (let light = 0; light <= 1; light += 1e-4) {
      const exact = light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055;
      const curved = half * Math.sqrt(light) + quarter * light ** 0.25 + whole * light + one;
      const shown = light <= STRAIGHT.to ? STRAIGHT.slope * light : curved;
      expect(Math.abs(shown - exact) * 255).toBeLessThan(0.2);
    }
  });

  it("take the place of the powers in every shader", () => {
    expect(ShaderChunk.colorspace_pars_fragment).toContain("pow(");
    useFastColours();
    const [, after] = ShaderChunk.colorspace_pars_fragment.split("sRGBTransferOETF");
    expect(after).toContain("sqrt(root)");
    expect(after).not.toContain("pow(");
  });
});
