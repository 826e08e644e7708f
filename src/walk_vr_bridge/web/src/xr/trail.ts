// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** Breadcrumbs: the places of the one who strays from the tour, so that the way back is one that was walked. */

export const MAX_CRUMBS = 512;
/** A crumb is dropped after this much way [m]. */
const EVERY_M = 0.25;

export class Trail {
  count = 0;
  private readonly at = new Float32Array(MAX_CRUMBS * 3);

  clear(): void {
    this.count = 0;
  }

  x(index: number): number {
    return this.at[3 * index];
  }

  y(index: number): number {
    return this.at[3 * index + 1];
  }

  z(index: number): number {
    return this.at[3 * index + 2];
  }

  /** Notes a place if it is new; who comes back to an older one has walked a loop, which is cut off. */
  drop(x: number, y: number, z: number): void {
    for (let i = 0; i < this.count; i++) {
      if (this.distance(i, x, y, z) >= EVERY_M) continue;
      this.count = i + 1;
      return;
    }
    if (this.count === MAX_CRUMBS) this.thin();
    this.at[3 * this.count] = x;
    this.at[3 * this.count + 1] = y;
    this.at[3 * this.count + 2] = z;
    this.count += 1;
  }

  private distance(i: number, x: number, y: number, z: number): number {
    return Math.hypot(this.at[3 * i] - x, this.at[3 * i + 1] - y, this.at[3 * i + 2] - z);
  }

  /** Full: every second crumb goes, the first stays. */
  private thin(): void {
    for (let i = 0; 2 * i < this.count; i++) this.at.copyWithin(3 * i, 6 * i, 6 * i + 3);
    this.count = Math.ceil(this.count / 2);
  }
}
