// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { GlbError, readGlb } from "../../src/scene/glb";

/** A file as the bridge writes them: quantised positions, put in place by the node. */
function file(): ArrayBuffer {
  const index = {
    asset: { version: "2.0" },
    nodes: [
      {
        name: "stair/1",
        mesh: 0,
        scale: [0.5, 0.5, 0.5],
        translation: [10, 20, 30],
        extras: { group: "stair", storey: 1, parts: [["Stair 1", "IfcStair", 1]] },
      },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    accessors: [
      { bufferView: 0, componentType: 5122, count: 3, type: "VEC3" },
      { bufferView: 1, componentType: 5123, count: 3, type: "SCALAR" },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: 24, byteStride: 8 },
      { buffer: 0, byteOffset: 24, byteLength: 6 },
    ],
  };
  let text = JSON.stringify(index);
  while (text.length % 4) text += " ";
  const bytes = new ArrayBuffer(20 + text.length + 8 + 32);
  const view = new DataView(bytes);
  view.setUint32(0, 0x46546c67, true);
  view.setUint32(4, 2, true);
  view.setUint32(8, bytes.byteLength, true);
  view.setUint32(12, text.length, true);
  view.setUint32(16, 0x4e4f534a, true);
  new Uint8Array(bytes, 20).set(new TextEncoder().encode(text));
  const binary = 28 + text.length;
  const corners = [[-2, 0, 4], [2, 0, 4], [0, 6, -4]];
  corners.forEach((corner, v) => corner.forEach((value, axis) => view.setInt16(binary + 8 * v + 2 * axis, value, true)));
  [2, 0, 1].forEach((value, i) => view.setUint16(binary + 24 + 2 * i, value, true));
  return bytes;
}

describe("the building's file", () => {
  it("is read with its quantised places, its storey and its parts", () => {
    const [mesh] = readGlb(file());
    expect(mesh.group).toBe("stair");
    expect(mesh.storey).toBe(1);
    expect(mesh.parts).toEqual([{ name: "Stair 1", kind: "IfcStair", first: 0, count: 3 }]);
    expect(Array.from(mesh.positions)).toEqual([9, 20, 32, 11, 20, 32, 10, 23, 28]);
    expect(Array.from(mesh.indices)).toEqual([2, 0, 1]);
  });

  it("is refused with a sentence where it is none", () => {
    expect(() => readGlb(new ArrayBuffer(64))).toThrow(GlbError);
    expect(() => readGlb(new ArrayBuffer(2))).toThrow(RangeError);
  });
});
