// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** The importance volume as a texture, and the points of it that are worth showing. */

import { BufferAttribute, BufferGeometry, Data3DTexture, LinearFilter, RGBAFormat, UnsignedByteType } from "three";
import type { ChannelName, ImportanceState, Storey } from "../client/state";
import { CUT_OVER_FLOOR_M } from "./clipping";

export const MAX_POINTS = 20000;

/** Returns the four maps as one texture, as they came. */
export function makeTexture(map: ImportanceState): Data3DTexture {
  const [nx, ny, nz] = map.shape;
  // A typed array of a larger buffer would be sent as it is; three.js wants one over a plain buffer.
  const texture = new Data3DTexture(new Uint8Array(map.data), nx, ny, nz);
  texture.format = RGBAFormat;
  texture.type = UnsignedByteType;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}

export function channelIndex(map: ImportanceState, channel: ChannelName): number {
  return map.channels.findIndex(({ name }) => name === channel);
}

/**
 * Chooses at most MAX_POINTS voxels to show: occupied ones of the obstacle map, else free ones, the more of them the higher
 * their value. The choice is the same every time.
 *
 * @returns points in the map's coordinates with the value as `aValue`, 0 to 1.
 */
export function choosePoints(map: ImportanceState, channel: ChannelName): BufferGeometry {
  const [nx, ny, nz] = map.shape;
  const count = nx * ny * nz;
  const full = channelIndex(map, "obstacle");
  const shown = channelIndex(map, channel);
  const weigh = (i: number): number => {
    const occupied = map.data[4 * i + full] > 127;
    if (channel === "obstacle") return occupied ? 1 : 0;
    return occupied ? 0 : (map.data[4 * i + shown] / 255) ** 2;
  };
  let total = 0;
  for (let i = 0; i < count; i++) total += weigh(i);
  const share = total > 0 ? Math.min(1, (0.95 * MAX_POINTS) / total) : 0;
  const places: number[] = [];
  const values: number[] = [];
  for (let i = 0; i < count && values.length < MAX_POINTS; i++) {
    if (scatter(i) >= weigh(i) * share) continue;
    const at = [i % nx, Math.floor(i / nx) % ny, Math.floor(i / (nx * ny))];
    for (let axis = 0; axis < 3; axis++) places.push(map.origin[axis] + (at[axis] + 0.5) * map.voxelM);
    values.push(map.data[4 * i + shown] / 255);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(places), 3));
  geometry.setAttribute("aValue", new BufferAttribute(Float32Array.from(values), 1));
  return geometry;
}

/** Fewer voxels than this say nothing about what is usual. */
const ENOUGH = 20;

/**
 * Returns between which values, 0 to 1, the map lies where one walks: the 2nd and 98th percentile over the floors, at the height of
 * a cut, each voxel once. The colours are spread over these: outdoors, values can be far from any indoors.
 */
export function rangeIndoors(map: ImportanceState, channel: ChannelName, storeys: readonly Storey[]): [number, number] {
  const [nx, ny, nz] = map.shape;
  const [full, shown] = [channelIndex(map, "obstacle"), channelIndex(map, channel)];
  const seen = new Uint8Array(nx * ny * nz);
  const values: number[] = [];
  const voxel = (value: number, axis: 0 | 1 | 2): number => (value - map.origin[axis]) / map.voxelM;
  for (const { floor } of storeys) {
    for (let tile = 0; tile < floor.length; tile += 5) {
      const layer = Math.floor(voxel(floor[tile + 4] + CUT_OVER_FLOOR_M, 2));
      if (layer < 0 || layer >= nz) continue;
      const rows = within(voxel(floor[tile + 1], 1), voxel(floor[tile + 3], 1), ny);
      const columns = within(voxel(floor[tile], 0), voxel(floor[tile + 2], 0), nx);
      for (let row = rows[0]; row < rows[1]; row++) {
        for (let column = columns[0]; column < columns[1]; column++) {
          const at = layer * nx * ny + row * nx + column;
          if (seen[at] || map.data[4 * at + full] > 127) continue;
          seen[at] = 1;
          values.push(map.data[4 * at + shown]);
        }
      }
    }
  }
  if (channel === "obstacle" || values.length < ENOUGH) return [0, 1];
  values.sort((a, b) => a - b);
  const percentile = (share: number): number => values[Math.round(share * (values.length - 1))] / 255;
  return [percentile(0.02), percentile(0.98)];
}

/** The voxels of an axis that a stretch of it meets: the first, and the one after the last. */
function within(low: number, high: number, count: number): [number, number] {
  return [Math.max(0, Math.floor(low + 1e-6)), Math.min(count, Math.ceil(high - 1e-6))];
}

/** A number from 0 up to 1 that looks random and is always the same for an index. */
function scatter(index: number): number {
  let x = (index + 0x9e3779b9) | 0;
  x = Math.imul(x ^ (x >>> 16), 0x85ebca6b);
  x = Math.imul(x ^ (x >>> 13), 0xc2b2ae35);
  return ((x ^ (x >>> 16)) >>> 0) / 4294967296;
}
