// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** What the triangles of a part make together: a solid, turned the right way, and the edges worth drawing. */

import type { BuildingMesh, Part } from "./glb";

export interface Topology {
  /** Per vertex 1 where its part encloses a volume: only such a part is filled where it is cut. */
  readonly solid: Uint8Array;
  /** Ends of the edges that are drawn, 6 numbers each [m]. */
  readonly edges: Float32Array;
}

const CREASE_COS = Math.cos((30 * Math.PI) / 180);
const MAX_VERTICES = 1 << 26;

interface Edge {
  readonly a: number;
  readonly b: number;
  readonly face: number;
  count: number;
  balance: number;
  crease: boolean;
}

/** Finds solids and edges; turns the triangles of solids that are inside out, in place. */
export function readTopology(mesh: BuildingMesh, leastEdgeM: number): Topology {
  const same = weld(mesh.positions);
  const normals = faceNormals(mesh);
  const solid = new Uint8Array(mesh.positions.length / 3);
  const ends: number[] = [];
  for (const part of mesh.parts) {
    const edges = partEdges(mesh, part, same, normals);
    if (isClosed(edges)) makeSolid(mesh, part, solid);
    for (const edge of edges.values()) if (edge.crease) pushEdge(ends, mesh.positions, edge, leastEdgeM);
  }
  return { solid, edges: Float32Array.from(ends) };
}

/** Maps each vertex to the first one at its place. */
function weld(positions: Float32Array): Uint32Array {
  const first = new Map<string, number>();
  const same = new Uint32Array(positions.length / 3);
  for (let v = 0; v < same.length; v++) {
    const key = `${positions[3 * v]},${positions[3 * v + 1]},${positions[3 * v + 2]}`;
    const known = first.get(key);
    if (known === undefined) first.set(key, v);
    same[v] = known ?? v;
  }
  return same;
}

function faceNormals({ positions: p, indices }: BuildingMesh): Float32Array {
  const normals = new Float32Array(indices.length);
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [3 * indices[i], 3 * indices[i + 1], 3 * indices[i + 2]];
    const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.hypot(x, y, z) || 1;
    normals.set([x / length, y / length, z / length], i);
  }
  return normals;
}

function partEdges(mesh: BuildingMesh, part: Part, same: Uint32Array, normals: Float32Array): Map<number, Edge> {
  const edges = new Map<number, Edge>();
  for (let i = part.first; i < part.first + part.count; i += 3) {
    for (let side = 0; side < 3; side++) {
      const a = same[mesh.indices[i + side]];
      const b = same[mesh.indices[i + ((side + 1) % 3)]];
      if (a === b) continue;
      const key = Math.min(a, b) * MAX_VERTICES + Math.max(a, b);
      const edge = edges.get(key);
      if (!edge) {
        edges.set(key, { a, b, face: i, count: 1, balance: a < b ? 1 : -1, crease: true });
        continue;
      }
      edge.count += 1;
      edge.balance += a < b ? 1 : -1;
      edge.crease = edge.count > 2 ? edge.crease : isCrease(normals, edge.face, i);
    }
  }
  return edges;
}

/** Triangles that lie flat beside each other make no edge, whichever way round they are. */
function isCrease(n: Float32Array, f: number, g: number): boolean {
  return Math.abs(n[f] * n[g] + n[f + 1] * n[g + 1] + n[f + 2] * n[g + 2]) < CREASE_COS;
}

function isClosed(edges: Map<number, Edge>): boolean {
  for (const edge of edges.values()) if (edge.balance !== 0) return false;
  return edges.size > 0;
}

function makeSolid(mesh: BuildingMesh, part: Part, solid: Uint8Array): void {
  const { positions: p, indices } = mesh;
  const end = part.first + part.count;
  let volume = 0;
  for (let i = part.first; i < end; i += 3) {
    const [a, b, c] = [3 * indices[i], 3 * indices[i + 1], 3 * indices[i + 2]];
    volume += p[a] * (p[b + 1] * p[c + 2] - p[b + 2] * p[c + 1]);
    volume += p[a + 1] * (p[b + 2] * p[c] - p[b] * p[c + 2]);
    volume += p[a + 2] * (p[b] * p[c + 1] - p[b + 1] * p[c]);
  }
  for (let i = part.first; i < end; i++) solid[indices[i]] = 1;
  if (volume >= 0) return;
  for (let i = part.first; i < end; i += 3) [indices[i], indices[i + 1]] = [indices[i + 1], indices[i]];
}

function pushEdge(ends: number[], p: Float32Array, edge: Edge, leastM: number): void {
  const [a, b] = [3 * edge.a, 3 * edge.b];
  if (Math.hypot(p[a] - p[b], p[a + 1] - p[b + 1], p[a + 2] - p[b + 2]) < leastM) return;
  ends.push(p[a], p[a + 1], p[a + 2], p[b], p[b + 1], p[b + 2]);
}
