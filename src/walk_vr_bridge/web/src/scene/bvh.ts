// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** Rays against the building: a tree of boxes over the triangles in flat arrays. Asking allocates nothing. */

const LEAF = 8;
const EPSILON = 1e-9;

export interface Hit {
  /** Infinity: nothing was hit. */
  distance: number;
  /** Of the triangle, turned against the ray. */
  nx: number;
  ny: number;
  nz: number;
}

export class Bvh {
  readonly hit: Hit = { distance: Infinity, nx: 0, ny: 0, nz: 0 };
  private readonly order: Uint32Array;
  /** Six numbers a node: lowest and highest corner. */
  private readonly boxes: Float32Array;
  /** Two numbers a node: a leaf has its first triangle and −count, a branch its second child and 0. */
  private readonly links: Int32Array;
  private readonly stack = new Int32Array(128);
  private nodes = 0;
  private readonly origin = new Float64Array(3);
  private readonly inverse = new Float64Array(3);

  /** @param corners nine numbers a triangle [m]. */
  constructor(private readonly corners: Float32Array) {
    const count = corners.length / 9;
    this.order = Uint32Array.from({ length: count }, (_, i) => i);
    const most = Math.max(1, 2 * count);
    this.boxes = new Float32Array(most * 6);
    this.links = new Int32Array(most * 2);
    if (count) this.split(0, count);
  }

  /** Sends a ray of unit direction; the answer stands in `hit` until the next one. */
  cast(ox: number, oy: number, oz: number, dx: number, dy: number, dz: number, least = 0, most = Infinity): Hit {
    const hit = this.hit;
    hit.distance = most;
    this.origin[0] = ox;
    this.origin[1] = oy;
    this.origin[2] = oz;
    this.inverse[0] = 1 / (dx || EPSILON);
    this.inverse[1] = 1 / (dy || EPSILON);
    this.inverse[2] = 1 / (dz || EPSILON);
    let found = false;
    let top = 0;
    if (this.nodes) this.stack[top++] = 0;
    while (top > 0) {
      const node = this.stack[--top];
      if (!this.meets(node, least, hit.distance)) continue;
      const count = -this.links[2 * node + 1];
      if (count === 0) {
        this.stack[top++] = this.links[2 * node];
        this.stack[top++] = node + 1;
        continue;
      }
      const first = this.links[2 * node];
      for (let i = first; i < first + count; i++) {
        found = this.triangle(this.order[i], ox, oy, oz, dx, dy, dz, least) || found;
      }
    }
    if (!found) hit.distance = Infinity;
    return hit;
  }

  private triangle(
    index: number,
    ox: number,
    oy: number,
    oz: number,
    dx: number,
    dy: number,
    dz: number,
    least: number,
  ): boolean {
    const p = this.corners;
    const at = 9 * index;
    const e1x = p[at + 3] - p[at];
    const e1y = p[at + 4] - p[at + 1];
    const e1z = p[at + 5] - p[at + 2];
    const e2x = p[at + 6] - p[at];
    const e2y = p[at + 7] - p[at + 1];
    const e2z = p[at + 8] - p[at + 2];
    const px = dy * e2z - dz * e2y;
    const py = dz * e2x - dx * e2z;
    const pz = dx * e2y - dy * e2x;
    const det = e1x * px + e1y * py + e1z * pz;
    if (Math.abs(det) < EPSILON) return false;
    const tx = ox - p[at];
    const ty = oy - p[at + 1];
    const tz = oz - p[at + 2];
    const u = (tx * px + ty * py + tz * pz) / det;
    if (u < 0 || u > 1) return false;
    const qx = ty * e1z - tz * e1y;
    const qy = tz * e1x - tx * e1z;
    const qz = tx * e1y - ty * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (v < 0 || u + v > 1) return false;
    const distance = (e2x * qx + e2y * qy + e2z * qz) / det;
    if (distance < least || distance >= this.hit.distance) return false;
    this.keep(distance, e1y * e2z - e1z * e2y, e1z * e2x - e1x * e2z, e1x * e2y - e1y * e2x, dx, dy, dz);
    return true;
  }

  private keep(distance: number, x: number, y: number, z: number, dx: number, dy: number, dz: number): void {
    const sign = (x * dx + y * dy + z * dz > 0 ? -1 : 1) / (Math.hypot(x, y, z) || 1);
    this.hit.distance = distance;
    this.hit.nx = x * sign;
    this.hit.ny = y * sign;
    this.hit.nz = z * sign;
  }

  private meets(node: number, least: number, most: number): boolean {
    const at = 6 * node;
    for (let axis = 0; axis < 3; axis++) {
      const near = (this.boxes[at + axis] - this.origin[axis]) * this.inverse[axis];
      const far = (this.boxes[at + 3 + axis] - this.origin[axis]) * this.inverse[axis];
      least = Math.max(least, Math.min(near, far));
      most = Math.min(most, Math.max(near, far));
    }
    return least <= most;
  }

  /** Makes the node of the triangles from `first` up to `end`: halves by their middles along the longest side. */
  private split(first: number, end: number): void {
    const node = this.nodes++;
    this.bound(node, first, end);
    if (end - first <= LEAF) {
      this.links[2 * node] = first;
      this.links[2 * node + 1] = first - end;
      return;
    }
    const half = (first + end) >> 1;
    this.halve(first, end - 1, half, this.longest(node));
    this.split(first, half);
    this.links[2 * node] = this.nodes;
    this.split(half, end);
  }

  /** Puts the triangles with the lower middles before place `half`, the others behind (quickselect). */
  private halve(low: number, high: number, half: number, axis: number): void {
    const { order } = this;
    while (low < high) {
      const pivot = this.middle(order[(low + high) >> 1], axis);
      let [i, j] = [low, high];
      while (i <= j) {
        while (this.middle(order[i], axis) < pivot) i++;
        while (this.middle(order[j], axis) > pivot) j--;
        if (i > j) break;
        const swapped = order[i];
        order[i++] = order[j];
        order[j--] = swapped;
      }
      if (half <= j) high = j;
      else if (half >= i) low = i;
      else return;
    }
  }

  private middle(triangle: number, axis: number): number {
    const at = 9 * triangle + axis;
    return this.corners[at] + this.corners[at + 3] + this.corners[at + 6];
  }

  private longest(node: number): number {
    const side = (axis: number): number => this.boxes[6 * node + 3 + axis] - this.boxes[6 * node + axis];
    const [x, y, z] = [side(0), side(1), side(2)];
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  }

  private bound(node: number, first: number, end: number): void {
    const at = 6 * node;
    for (let axis = 0; axis < 3; axis++) {
      let [low, high] = [Infinity, -Infinity];
      for (let i = first; i < end; i++) {
        for (let corner = 0; corner < 3; corner++) {
          const value = this.corners[9 * this.order[i] + 3 * corner + axis];
          if (value < low) low = value;
          if (value > high) high = value;
        }
      }
      // A hair wider: a ray along a wall must not fall between the boxes of its two triangles.
      this.boxes[at + axis] = low - 1e-4;
      this.boxes[at + 3 + axis] = high + 1e-4;
    }
  }
}
