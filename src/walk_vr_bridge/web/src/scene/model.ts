// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** The geometry of a building as it is drawn: everything solid in one buffer, glass in another, edges as lines. */

import { Box3, BufferAttribute, BufferGeometry, Color } from "three";
import { Bvh } from "./bvh";
import { type Facets, facetsOf } from "./facets";
import type { BuildingMesh } from "./glb";
import { colourOfPart } from "./palette";
import { readTopology } from "./topology";

export interface BuildingModel {
  readonly surface: BufferGeometry;
  readonly glass: BufferGeometry;
  readonly edges: BufferGeometry;
  readonly bounds: Box3;
  readonly triangles: number;
}

/** Builds what is drawn of the meshes; edges shorter than `leastEdgeM` are left out. */
export function buildModel(meshes: readonly BuildingMesh[], leastEdgeM: number): BuildingModel {
  const opaque = meshes.filter((mesh) => mesh.group !== "glass");
  const glass = meshes.filter((mesh) => mesh.group === "glass");
  const edges: Float32Array[] = [];
  const surface = merge(opaque, edges, leastEdgeM);
  const panes = merge(glass, edges, leastEdgeM);
  const bounds = new Box3();
  for (const mesh of meshes) bounds.union(new Box3().setFromArray(mesh.positions));
  const triangles = meshes.reduce((sum, mesh) => sum + mesh.indices.length / 3, 0);
  return { surface, glass: panes, edges: lines(edges), bounds, triangles };
}

/** The tree for rays: what stands still and hides what is behind it, so neither glass nor doors. */
export function buildBvh(meshes: readonly BuildingMesh[]): Bvh {
  return treeOf(meshes.filter((mesh) => mesh.group !== "glass" && mesh.group !== "door"));
}

/** The tree of what one sees through and yet cannot walk through. */
export function buildPanes(meshes: readonly BuildingMesh[]): Bvh {
  return treeOf(meshes.filter((mesh) => mesh.group === "glass"));
}

function treeOf(solid: readonly BuildingMesh[]): Bvh {
  const corners = new Float32Array(solid.reduce((sum, mesh) => sum + mesh.indices.length * 3, 0));
  let at = 0;
  for (const { positions, indices } of solid) {
    for (let i = 0; i < indices.length; i++) {
      for (let axis = 0; axis < 3; axis++) corners[at++] = positions[3 * indices[i] + axis];
    }
  }
  return new Bvh(corners);
}

function merge(meshes: readonly BuildingMesh[], edges: Float32Array[], leastEdgeM: number): BufferGeometry {
  // First the topology: it turns the triangles of solids that are inside out.
  const topologies = meshes.map((mesh) => readTopology(mesh, leastEdgeM));
  const facets = meshes.map(facetsOf);
  const vertices = facets.reduce((sum, { source }) => sum + source.length, 0);
  const positions = new Float32Array(vertices * 3);
  const colours = new Uint8Array(vertices * 3);
  const kinds = new Uint8Array(vertices * 4);
  const indices = new Uint32Array(meshes.reduce((sum, mesh) => sum + mesh.indices.length, 0));
  let [vertex, index] = [0, 0];
  meshes.forEach((mesh, number) => {
    const { source, normals, indices: corners } = facets[number];
    const { solid } = topologies[number];
    edges.push(topologies[number].edges);
    for (let v = 0; v < source.length; v++) {
      positions.set(mesh.positions.subarray(3 * source[v], 3 * source[v] + 3), 3 * (vertex + v));
      kinds.set(normals.subarray(3 * v, 3 * v + 3), 4 * (vertex + v));
      kinds[4 * (vertex + v) + 3] = solid[source[v]] * 255;
    }
    paint(mesh, facets[number], colours, vertex);
    for (let i = 0; i < corners.length; i++) indices[index++] = corners[i] + vertex;
    vertex += source.length;
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("color", new BufferAttribute(colours, 3, true));
  geometry.setAttribute("aKind", new BufferAttribute(kinds, 4));
  geometry.setIndex(new BufferAttribute(indices, 1));
  if (vertices) geometry.computeBoundingSphere();
  return geometry;
}

/** Paints the last vertex of each triangle. */
function paint(mesh: BuildingMesh, { indices }: Facets, colours: Uint8Array, vertex: number): void {
  const colour = new Color();
  for (const part of mesh.parts) {
    colourOfPart(mesh.group, part, colour);
    const [r, g, b] = [colour.r * 255, colour.g * 255, colour.b * 255];
    for (let i = part.first + 2; i < part.first + part.count; i += 3) {
      const at = 3 * (vertex + indices[i]);
      colours[at] = r;
      colours[at + 1] = g;
      colours[at + 2] = b;
    }
  }
}

function lines(edges: readonly Float32Array[]): BufferGeometry {
  const ends = new Float32Array(edges.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of edges) {
    ends.set(part, at);
    at += part.length;
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(ends, 3));
  if (ends.length) geometry.computeBoundingSphere();
  return geometry;
}
