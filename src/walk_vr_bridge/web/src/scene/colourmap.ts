// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** Colour scales: dark blue over green to yellow, lightness rising, so that they read without colour vision too. */

const STOPS = [
  [0.17, 0.11, 0.38],
  [0.16, 0.3, 0.58],
  [0.1, 0.5, 0.58],
  [0.2, 0.68, 0.44],
  [0.62, 0.82, 0.25],
  [0.99, 0.91, 0.25],
] as const;

/** Writes the colour (sRGB, 0 to 1) of a value 0 to 1 into three numbers of the target. */
export function writeScale(value: number, target: Float32Array, at: number): void {
  const clamped = Math.min(1, Math.max(0, Number.isFinite(value) ? value : 0));
  const place = clamped * (STOPS.length - 1);
  const low = Math.min(STOPS.length - 2, Math.floor(place));
  const part = place - low;
  for (let c = 0; c < 3; c++) target[at + c] = STOPS[low][c] * (1 - part) + STOPS[low + 1][c] * part;
}

/** The same scale as GLSL: `vec3 scaleColour(float value)`, sRGB. */
export const SCALE_GLSL = `
vec3 scaleColour(float value) {
  vec3 stops[${STOPS.length}];
${STOPS.map((stop, i) => `  stops[${i}] = vec3(${stop.map((x) => x.toFixed(3)).join(", ")});`).join("\n")}
  float place = clamp(value, 0.0, 1.0) * ${(STOPS.length - 1).toFixed(1)};
  int low = int(min(floor(place), ${(STOPS.length - 2).toFixed(1)}));
  return mix(stops[low], stops[low + 1], place - float(low));
}`;
