// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** Reads the bridge's GLB files: quantised positions, indices and the names of the parts; see docs/protocol.md. */

export type GroupName = "structure" | "ceiling" | "glass" | "stair" | "door" | "furniture";

export interface Part {
  readonly name: string;
  readonly kind: string;
  /** First index in the mesh's index buffer, and how many: three a triangle. */
  readonly first: number;
  readonly count: number;
}

export interface BuildingMesh {
  readonly group: GroupName;
  readonly storey: number;
  readonly parts: readonly Part[];
  /** 3 per vertex, metres, z up. */
  readonly positions: Float32Array;
  readonly indices: Uint32Array;
}

export class GlbError extends Error {
  override readonly name = "GlbError";
}

interface Accessor {
  bufferView: number;
  byteOffset?: number;
  componentType: number;
  count: number;
}
interface Gltf {
  accessors: Accessor[];
  bufferViews: { byteOffset?: number; byteLength: number; byteStride?: number }[];
  meshes: { primitives: { attributes: { POSITION: number }; indices: number }[] }[];
  nodes: {
    name?: string;
    mesh?: number;
    scale?: number[];
    translation?: number[];
    extras?: { group?: string; storey?: number; parts?: [string, string, number][] };
  }[];
}

const MAGIC = 0x46546c67;
const JSON_CHUNK = 0x4e4f534a;
const GROUPS: readonly string[] = ["structure", "ceiling", "glass", "stair", "door", "furniture"];

/** Returns the meshes of the file, in metres. @throws GlbError, or RangeError where the file is cut short. */
export function readGlb(file: ArrayBuffer): BuildingMesh[] {
  const view = new DataView(file);
  if (view.getUint32(0, true) !== MAGIC) throw new GlbError("the building is no GLB file");
  const length = view.getUint32(12, true);
  if (view.getUint32(16, true) !== JSON_CHUNK) throw new GlbError("the building's file does not begin with its index");
  const gltf = JSON.parse(new TextDecoder().decode(new Uint8Array(file, 20, length))) as Gltf;
  const binary = 20 + length + 8;
  const meshes: BuildingMesh[] = [];
  for (const node of gltf.nodes) {
    if (node.mesh === undefined) continue;
    for (const primitive of gltf.meshes[node.mesh].primitives) {
      const indices = readIndices(view, gltf, binary, primitive.indices);
      const positions = readPositions(view, gltf, binary, primitive.attributes.POSITION);
      place(positions, node.scale ?? [1, 1, 1], node.translation ?? [0, 0, 0]);
      meshes.push({ ...describe(node, indices.length), positions, indices });
    }
  }
  return meshes;
}

function describe(node: Gltf["nodes"][number], indices: number): Pick<BuildingMesh, "group" | "storey" | "parts"> {
  const name = node.extras?.group ?? node.name?.split("/")[0] ?? "structure";
  const group = (GROUPS.includes(name) ? name : "structure") as GroupName;
  const parts: Part[] = [];
  let first = 0;
  for (const [part, kind, triangles] of node.extras?.parts ?? []) {
    parts.push({ name: part, kind, first, count: triangles * 3 });
    first += triangles * 3;
  }
  if (first !== indices) return { group, storey: node.extras?.storey ?? -1, parts: [whole(name, indices)] };
  return { group, storey: node.extras?.storey ?? -1, parts };
}

function whole(name: string, count: number): Part {
  return { name, kind: "", first: 0, count };
}

function readIndices(view: DataView, gltf: Gltf, binary: number, index: number): Uint32Array {
  const accessor = gltf.accessors[index];
  const start = binary + (gltf.bufferViews[accessor.bufferView].byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  const values = new Uint32Array(accessor.count);
  const wide = accessor.componentType === 5125;
  for (let i = 0; i < values.length; i++) {
    values[i] = wide ? view.getUint32(start + 4 * i, true) : view.getUint16(start + 2 * i, true);
  }
  return values;
}

function readPositions(view: DataView, gltf: Gltf, binary: number, index: number): Float32Array {
  const accessor = gltf.accessors[index];
  const holder = gltf.bufferViews[accessor.bufferView];
  const start = binary + (holder.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  const float = accessor.componentType === 5126;
  const size = float ? 4 : 2;
  const stride = holder.byteStride ?? 3 * size;
  const values = new Float32Array(accessor.count * 3);
  for (let i = 0; i < values.length; i++) {
    const at = start + stride * Math.floor(i / 3) + size * (i % 3);
    values[i] = float ? view.getFloat32(at, true) : view.getInt16(at, true);
  }
  return values;
}

function place(positions: Float32Array, scale: readonly number[], translation: readonly number[]): void {
  for (let i = 0; i < positions.length; i++) positions[i] = positions[i] * scale[i % 3] + translation[i % 3];
}
