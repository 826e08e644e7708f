// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/**
 * The path as a tube in buffers of fixed size: a ribbon along its middle line, which the shader turns to the viewer, makes as
 * wide as the tube and lights as a round one. A sixth of the triangles of a tube with six sides.
 */

import { BufferAttribute, BufferGeometry, DynamicDrawUsage } from "three";

export const MAX_RINGS = 1024;
/** Vertices of a ring: the ribbon's two edges. */
export const EDGES = 2;

export class PathTube {
  readonly geometry = new BufferGeometry();
  /** Rings in use: places of the middle line. */
  rings = 0;
  /** Which row of the path each ring shows. */
  readonly rowOf = new Uint32Array(MAX_RINGS);
  private readonly middle = new BufferAttribute(new Float32Array(MAX_RINGS * EDGES * 3), 3);
  private readonly along = new BufferAttribute(new Float32Array(MAX_RINGS * EDGES * 3), 3);
  private readonly colour = new BufferAttribute(new Uint8Array(MAX_RINGS * EDGES * 4), 4, true);

  constructor() {
    for (const attribute of [this.middle, this.along, this.colour]) attribute.setUsage(DynamicDrawUsage);
    const edges = Int8Array.from({ length: MAX_RINGS * EDGES }, (_, vertex) => (vertex % EDGES ? 1 : -1));
    this.geometry.setAttribute("position", this.middle);
    this.geometry.setAttribute("aAlong", this.along);
    this.geometry.setAttribute("aEdge", new BufferAttribute(edges, 1));
    this.geometry.setAttribute("color", this.colour);
    this.geometry.setIndex(new BufferAttribute(skin(), 1));
    this.geometry.setDrawRange(0, 0);
  }

  /** Takes over the rows of a path, 3 numbers each [m]; of a path with too many rows every second, third, … */
  setPath(positions: Float32Array, count: number): void {
    const rings = Math.min(count, MAX_RINGS);
    let [x, y, z] = [1, 0, 0];
    for (let ring = 0; ring < rings; ring++) {
      const row = rings < 2 ? 0 : Math.round((ring * (count - 1)) / (rings - 1));
      this.rowOf[ring] = row;
      const before = 3 * Math.max(0, row - 1);
      const after = 3 * Math.min(count - 1, row + 1);
      const dx = positions[after] - positions[before];
      const dy = positions[after + 1] - positions[before + 1];
      const dz = positions[after + 2] - positions[before + 2];
      const length = Math.hypot(dx, dy, dz);
      // Where the path stands still, the ribbon goes on as before.
      if (length > 1e-6) [x, y, z] = [dx / length, dy / length, dz / length];
      this.writeRing(ring, positions, row, x, y, z);
    }
    this.rings = rings;
    this.geometry.setDrawRange(0, Math.max(0, rings - 1) * 6);
    this.upload(this.middle);
    this.upload(this.along);
  }

  /** Paints a ring, linear light 0 to 255. */
  paint(ring: number, r: number, g: number, b: number): void {
    const colours = this.colour.array;
    for (let at = ring * EDGES * 4; at < (ring + 1) * EDGES * 4; at += 4) {
      colours[at] = r;
      colours[at + 1] = g;
      colours[at + 2] = b;
      colours[at + 3] = 255;
    }
  }

  painted(): void {
    this.upload(this.colour);
  }

  /** Lets the graphics card have what is in use, and no more. */
  private upload(attribute: BufferAttribute): void {
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, this.rings * EDGES * attribute.itemSize);
    attribute.needsUpdate = true;
  }

  private writeRing(ring: number, positions: Float32Array, row: number, x: number, y: number, z: number): void {
    const middles = this.middle.array;
    const ways = this.along.array;
    for (let edge = 0; edge < EDGES; edge++) {
      const at = (ring * EDGES + edge) * 3;
      middles[at] = positions[3 * row];
      middles[at + 1] = positions[3 * row + 1];
      middles[at + 2] = positions[3 * row + 2];
      ways[at] = x;
      ways[at + 1] = y;
      ways[at + 2] = z;
    }
  }
}

function skin(): Uint16Array {
  const indices = new Uint16Array((MAX_RINGS - 1) * 6);
  for (let ring = 0; ring < MAX_RINGS - 1; ring++) {
    const a = ring * EDGES;
    indices.set([a, a + 1, a + EDGES, a + EDGES, a + 1, a + EDGES + 1], ring * 6);
  }
  return indices;
}
