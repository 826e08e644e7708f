// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/**
 * The last step of every shader, from linear light to sRGB, by square roots: in software the powers of three.js's own take
 * a quarter of what it takes to draw a wall.
 */

import { ShaderChunk } from "three";

/** Factors of x^(1/2), x^(1/4), x and 1 above the straight part: off by less than a tenth of a step of 255. */
export const ROOTS = [0.833735635, 0.298123953, -0.055311914, -0.076907223] as const;
/** Up to here sRGB is a straight line of this slope. */
export const STRAIGHT = { to: 0.0031308, slope: 12.92 } as const;

const [HALF, QUARTER, WHOLE, ONE] = ROOTS.map((factor) => factor.toFixed(9));
const EXACT = /vec4 sRGBTransferOETF\([^{]*\{[\s\S]*?\n\}/;
const BY_ROOTS = `vec4 sRGBTransferOETF( in vec4 value ) {
  vec3 root = sqrt(max(value.rgb, vec3(0.0)));
  vec3 curved = ${HALF} * root + ${QUARTER} * sqrt(root) + ${WHOLE} * value.rgb + ${ONE};
  bvec3 straight = lessThanEqual(value.rgb, vec3(${STRAIGHT.to.toFixed(7)}));
  return vec4(mix(curved, ${STRAIGHT.slope.toFixed(2)} * value.rgb, vec3(straight)), value.a);
}`;

/** Puts it in the place of three.js's own, for all materials that are compiled from now on. */
export function useFastColours(): void {
  ShaderChunk.colorspace_pars_fragment = ShaderChunk.colorspace_pars_fragment.replace(EXACT, BY_ROOTS);
}
