// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/**
 * Flat triangles for the graphics card: what holds for a whole triangle stands at its last vertex, which it shares only with
 * triangles of the same part that face the same way. Light is then worked out once a vertex, not at every pixel.
 */

import type { BuildingMesh } from "./glb";

export interface Facets {
  /** Per vertex, which of the mesh it is: those of the mesh first, then the ones that had to be doubled. */
  readonly source: Uint32Array;
  /** Corners of the triangles, turned the same way round as they were. */
  readonly indices: Uint32Array;
  /** Per vertex the normal of the triangles that end with it, 3 bytes: 128 is 0, 255 is 1. */
  readonly normals: Uint8Array;
}

const FREE = -1;

export function facetsOf(mesh: BuildingMesh): Facets {
  const source = Array.from({ length: mesh.positions.length / 3 }, (_, vertex) => vertex);
  // A part and a direction, as one number, of the triangles that end with a vertex.
  const holds: number[] = source.map(() => FREE);
  const indices = mesh.indices.slice();
  mesh.parts.forEach((part, number) => {
    for (let i = part.first; i < part.first + part.count; i += 3) {
      const wanted = number * 2 ** 24 + direction(mesh, i);
      const side = sideFor(mesh.indices, i, holds, wanted);
      const last = side < 0 ? source.length : mesh.indices[i + side];
      if (side < 0) source.push(mesh.indices[i + 2]);
      holds[last] = wanted;
      const turned = side < 0 ? 2 : side;
      indices[i] = mesh.indices[i + ((turned + 1) % 3)];
      indices[i + 1] = mesh.indices[i + ((turned + 2) % 3)];
      indices[i + 2] = last;
    }
  });
  const normals = new Uint8Array(source.length * 3);
  holds.forEach((held, vertex) => {
    if (held !== FREE) normals.set([(held >> 16) & 255, (held >> 8) & 255, held & 255], 3 * vertex);
  });
  return { source: Uint32Array.from(source), indices, normals };
}

/** Which corner of a triangle may be its last: one that holds the same already, or nothing yet; −1: none. */
function sideFor(indices: Uint32Array, i: number, holds: readonly number[], wanted: number): number {
  let free = -1;
  for (let side = 0; side < 3; side++) {
    const held = holds[indices[i + side]];
    if (held === wanted) return side;
    if (held === FREE) free = side;
  }
  return free;
}

/** The normal of a triangle as a number of 24 bits. */
function direction({ positions: p, indices }: BuildingMesh, i: number): number {
  const [a, b, c] = [3 * indices[i], 3 * indices[i + 1], 3 * indices[i + 2]];
  const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
  const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
  const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
  const length = Math.hypot(x, y, z) || 1;
  return (byte(x / length) << 16) | (byte(y / length) << 8) | byte(z / length);
}

function byte(value: number): number {
  return 128 + Math.round(127 * value);
}
