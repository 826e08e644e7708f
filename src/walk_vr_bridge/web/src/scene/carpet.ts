// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** The floors that one walks on as a geometry: what a map is laid on. */

import { BufferAttribute, BufferGeometry } from "three";
import type { Storey } from "../client/state";

/** How far over a floor it lies [m]. */
export const OVER_FLOOR_M = 0.04;

/** Returns the floors of all storeys, two triangles a piece, in the map's coordinates. */
export function makeCarpet(storeys: readonly Storey[]): BufferGeometry {
  const tiles = storeys.reduce((sum, { floor }) => sum + floor.length / 5, 0);
  const corners = new Float32Array(tiles * 4 * 3);
  const indices = new Uint32Array(tiles * 6);
  let tile = 0;
  for (const { floor } of storeys) {
    for (let at = 0; at < floor.length; at += 5, tile++) {
      const [x0, y0, x1, y1, z] = floor.subarray(at, at + 5);
      const height = z + OVER_FLOOR_M;
      corners.set([x0, y0, height, x1, y0, height, x1, y1, height, x0, y1, height], tile * 12);
      const first = tile * 4;
      indices.set([first, first + 1, first + 2, first, first + 2, first + 3], tile * 6);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(corners, 3));
  geometry.setIndex(new BufferAttribute(indices, 1));
  return geometry;
}
