// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** Clearance and height along the path, measured here by rays where the bridge has not said them. */

import type { PathState } from "../client/state";
import type { Bvh } from "./bvh";
import type { PathTube } from "./tube";

/** Rings measured in a frame: a few tenths of a millisecond. */
const RINGS_PER_FRAME = 16;
const DIRECTIONS = 12;
/** Heights at which rays leave the body, under the eye [m]: head, chest, knee. */
const BELOW_EYE_M = [0, 0.55, 1.1] as const;
/** Farther than this nothing is near [m]. */
const FAR_M = 1.2;
const DEEPEST_M = 6;

export class Profile {
  private revision = "";
  private ring = 0;

  /**
   * Measures some more rings of the path: the least distance from the body's side to the building over level rays, and how
   * high the eye is over the floor. Returns whether anything new was found.
   */
  step(path: PathState, tube: PathTube, bvh: Bvh, radiusM: number): boolean {
    if (path.revision !== this.revision) {
      this.revision = path.revision;
      this.ring = 0;
    }
    let found = false;
    const end = Math.min(tube.rings, this.ring + RINGS_PER_FRAME);
    for (; this.ring < end; this.ring++) {
      const row = tube.rowOf[this.ring];
      if (!Number.isNaN(path.clearanceM[row]) && !Number.isNaN(path.heightM[row])) continue;
      const { positions } = path;
      const [x, y, z] = [positions[3 * row], positions[3 * row + 1], positions[3 * row + 2]];
      path.clearanceM[row] = nearest(bvh, x, y, z) - radiusM;
      const { distance } = bvh.cast(x, y, z, 0, 0, -1, 0, DEEPEST_M);
      path.heightM[row] = distance < Infinity ? distance : NaN;
      found = true;
    }
    return found;
  }
}

function nearest(bvh: Bvh, x: number, y: number, z: number): number {
  let least = FAR_M;
  for (const below of BELOW_EYE_M) {
    for (let k = 0; k < DIRECTIONS; k++) {
      const angle = (2 * Math.PI * k) / DIRECTIONS;
      const hit = bvh.cast(x, y, z - below, Math.cos(angle), Math.sin(angle), 0, 0, least);
      if (hit.distance < least) least = hit.distance;
    }
  }
  return least;
}
