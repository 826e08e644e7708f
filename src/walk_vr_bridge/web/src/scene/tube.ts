// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** The path as a tube in buffers of fixed size: rings around its middle line, whose thickness the shader sets. */

import { BufferAttribute, BufferGeometry, DynamicDrawUsage } from "three";

export const MAX_RINGS = 1024;
export const SIDES = 6;

export class PathTube {
  readonly geometry = new BufferGeometry();
  /** Rings in use. */
  rings = 0;
  /** Which row of the path each ring shows. */
  readonly rowOf = new Uint32Array(MAX_RINGS);
  private readonly middle = new BufferAttribute(new Float32Array(MAX_RINGS * SIDES * 3), 3);
  private readonly offset = new BufferAttribute(new Float32Array(MAX_RINGS * SIDES * 3), 3);
  private readonly colour = new BufferAttribute(new Uint8Array(MAX_RINGS * SIDES * 3), 3, true);

  constructor() {
    for (const attribute of [this.middle, this.offset, this.colour]) attribute.setUsage(DynamicDrawUsage);
    this.geometry.setAttribute("position", this.middle);
    this.geometry.setAttribute("aOffset", this.offset);
    this.geometry.setAttribute("color", this.colour);
    this.geometry.setIndex(new BufferAttribute(skin(), 1));
    this.geometry.setDrawRange(0, 0);
  }

  /** Takes over the rows of a path, 3 numbers each [m]; of a path with too many rows every second, third, … */
  setPath(positions: Float32Array, count: number): void {
    const rings = Math.min(count, MAX_RINGS);
    let [sideX, sideY, sideZ] = [0, 1, 0];
    for (let ring = 0; ring < rings; ring++) {
      const row = rings < 2 ? 0 : Math.round((ring * (count - 1)) / (rings - 1));
      this.rowOf[ring] = row;
      const before = 3 * Math.max(0, row - 1);
      const after = 3 * Math.min(count - 1, row + 1);
      const tx = positions[after] - positions[before];
      const ty = positions[after + 1] - positions[before + 1];
      const tz = positions[after + 2] - positions[before + 2];
      const flat = Math.hypot(tx, ty);
      // Straight up, or standing: the ring keeps the last one's side, so that the tube never twists.
      if (flat > 1e-6) [sideX, sideY, sideZ] = [-ty / flat, tx / flat, 0];
      const length = Math.hypot(flat, tz) || 1;
      const upX = (ty * sideZ - tz * sideY) / length;
      const upY = (tz * sideX - tx * sideZ) / length;
      const upZ = (tx * sideY - ty * sideX) / length;
      this.writeRing(ring, positions, row, sideX, sideY, sideZ, upX, upY, upZ);
    }
    this.rings = rings;
    this.geometry.setDrawRange(0, Math.max(0, rings - 1) * SIDES * 6);
    this.middle.needsUpdate = true;
    this.offset.needsUpdate = true;
  }

  /** Paints a ring, linear light 0 to 255. */
  paint(ring: number, r: number, g: number, b: number): void {
    const colours = this.colour.array;
    for (let at = ring * SIDES * 3; at < (ring + 1) * SIDES * 3; at += 3) {
      colours[at] = r;
      colours[at + 1] = g;
      colours[at + 2] = b;
    }
  }

  painted(): void {
    this.colour.needsUpdate = true;
  }

  private writeRing(
    ring: number,
    positions: Float32Array,
    row: number,
    sx: number,
    sy: number,
    sz: number,
    ux: number,
    uy: number,
    uz: number,
  ): void {
    const middles = this.middle.array;
    const offsets = this.offset.array;
    for (let side = 0; side < SIDES; side++) {
      const at = (ring * SIDES + side) * 3;
      const c = COS[side];
      const s = SIN[side];
      middles[at] = positions[3 * row];
      middles[at + 1] = positions[3 * row + 1];
      middles[at + 2] = positions[3 * row + 2];
      offsets[at] = c * sx + s * ux;
      offsets[at + 1] = c * sy + s * uy;
      offsets[at + 2] = c * sz + s * uz;
    }
  }
}

const COS = Float32Array.from({ length: SIDES }, (_, side) => Math.cos((2 * Math.PI * side) / SIDES));
const SIN = Float32Array.from({ length: SIDES }, (_, side) => Math.sin((2 * Math.PI * side) / SIDES));

function skin(): Uint16Array {
  const indices = new Uint16Array((MAX_RINGS - 1) * SIDES * 6);
  let at = 0;
  for (let ring = 0; ring < MAX_RINGS - 1; ring++) {
    for (let side = 0; side < SIDES; side++) {
      const next = (side + 1) % SIDES;
      const [a, b] = [ring * SIDES + side, ring * SIDES + next];
      indices.set([a, a + SIDES, b, b, a + SIDES, b + SIDES], at);
      at += 6;
    }
  }
  return indices;
}
