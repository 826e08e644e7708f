// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/**
 * Height over the floor and clearance along the path, measured by rays in the building that the page shows, a little each
 * frame, and only while somebody looks at it. Between two rays something thin can be missed, and doors are no obstacles: the
 * exact figures are the planner's, in its diagnostics and reports.
 */

import type { PathState } from "./state";
import type { Store } from "./store";

/** What casts a ray: how far it goes, Infinity where it hits nothing within `most`. */
export interface Caster {
  cast(
    ox: number,
    oy: number,
    oz: number,
    dx: number,
    dy: number,
    dz: number,
    least?: number,
    most?: number,
  ): { readonly distance: number };
}

const DIRECTIONS = 12;
/**
 * Heights at which the body is measured [m]; the highest is the eye's. The body hangs from the eye as in the planner's own sweep:
 * over the floor right below it, it would stand in the side of the ramp that it has just left.
 */
const BODY_M = [0.35, 0.95] as const;
/** Farther than this nothing is measured: it is far enough [m]. */
export const FAR_M = 0.62;
const FLOOR_MOST_M = 4;
const ROWS_A_TURN = 16;
/** So often what has been measured so far is shown. */
const TELL_MS = 500;

export class PathMeasurer {
  private revision = "";
  private row = 0;
  private toldMs = 0;

  constructor(
    private readonly store: Store,
    private readonly obstacles: () => readonly Caster[] | null,
    private readonly now: () => number = () => performance.now(),
  ) {}

  /** Goes on for a few milliseconds where the path is coloured by what is not known yet. Allocates nothing. */
  step(budgetMs: number): void {
    const { path, settings, building } = this.store.state;
    const obstacles = this.obstacles();
    const wanted = settings.pathColour !== "plain" && settings.pathColour !== "speed";
    if (!wanted || !obstacles || !building || path.count === 0) return;
    if (path.revision !== this.revision) {
      this.revision = path.revision;
      this.row = 0;
      this.toldMs = this.now();
    }
    if (this.row >= path.count) return;
    const { radiusM, eyeHeightM } = building.walker;
    const end = this.now() + budgetMs;
    while (this.row < path.count && this.now() < end) {
      const stop = Math.min(path.count, this.row + ROWS_A_TURN);
      for (; this.row < stop; this.row++) measureRow(path, this.row, obstacles, radiusM, eyeHeightM);
    }
    const now = this.now();
    if (this.row < path.count && now < this.toldMs + TELL_MS) return;
    this.toldMs = now;
    this.store.touch("path");
  }
}

function measureRow(path: PathState, row: number, obstacles: readonly Caster[], radiusM: number, eyeM: number): void {
  const { positions, heightM, clearanceM } = path;
  const [x, y, z] = [positions[3 * row]!, positions[3 * row + 1]!, positions[3 * row + 2]!];
  const height = nearest(obstacles, x, y, z, 0, 0, -1, FLOOR_MOST_M);
  heightM[row] = height < FLOOR_MOST_M ? height : NaN;
  let least = around(obstacles, x, y, z, radiusM + FAR_M);
  for (const over of BODY_M) least = around(obstacles, x, y, z - eyeM + over, least);
  clearanceM[row] = least - radiusM;
}

/** The shortest of the level rays from a place, `most` where none is shorter. */
function around(obstacles: readonly Caster[], x: number, y: number, z: number, most: number): number {
  let least = most;
  for (let k = 0; k < DIRECTIONS; k++) {
    const angle = (2 * Math.PI * k) / DIRECTIONS;
    least = nearest(obstacles, x, y, z, Math.cos(angle), Math.sin(angle), 0, least);
  }
  return least;
}

/** How far a ray goes, `most` where it meets nothing before. */
function nearest(
  obstacles: readonly Caster[],
  x: number,
  y: number,
  z: number,
  dx: number,
  dy: number,
  dz: number,
  most: number,
): number {
  let least = most;
  for (let i = 0; i < obstacles.length; i++) {
    least = Math.min(least, obstacles[i]!.cast(x, y, z, dx, dy, dz, 0, least).distance);
  }
  return least;
}
