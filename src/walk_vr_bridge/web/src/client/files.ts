// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The building and the importance volume over HTTP, asked for until they are there. */

import { fields, finite, list, MessageError, triple, whole, words } from "./check";
import type { BuildingState, Channel, ChannelName, ImportanceState, ModelFile, Room, Storey } from "./state";

export type Fetch = (url: string) => Promise<Response>;

/** The server cannot have it: asking again is of no use until it says otherwise. */
export class FileError extends Error {
  override readonly name = "FileError";
}

const CHANNEL_NAMES: ReadonlySet<string> = new Set(["obstacle", "distance", "visibility", "importance"]);
const AGAIN_MS = 1000;
const MAX_VOXELS = 64e6;

/**
 * Returns the response to a request that may have to wait.
 *
 * @param alive asked before each attempt: false ends the waiting with null.
 * @throws FileError with the server's sentence where the file cannot be had.
 */
export async function patient(
  get: Fetch,
  url: string,
  alive: () => boolean,
  onWait: () => void,
): Promise<Response | null> {
  while (alive()) {
    const answer = await get(url).catch(() => null);
    if (answer?.ok) return answer;
    if (answer && answer.status !== 503) throw new FileError(await sentence(answer));
    onWait();
    await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
  }
  return null;
}

async function sentence(answer: Response): Promise<string> {
  const said = (await answer.json().catch(() => null)) as { error?: unknown } | null;
  return typeof said?.error === "string" ? said.error : `${answer.url} answered ${answer.status}`;
}

/** Returns what building.json says. @throws MessageError. */
export function buildingFrom(value: unknown): BuildingState {
  const said = fields(value, "building.json");
  const bounds = fields(said.bounds, "bounds");
  const walker = fields(said.walker, "walker");
  const glb = fields(said.glb, "glb");
  return {
    name: words(said.name, "name"),
    hash: words(said.hash, "hash"),
    model: modelFile(glb.building, "glb.building"),
    miniature: modelFile(glb.miniature, "glb.miniature"),
    min: triple(bounds.min, "bounds.min"),
    max: triple(bounds.max, "bounds.max"),
    start: triple(said.start, "start"),
    storeys: list(said.storeys, "storeys").map(storeyFrom),
    rooms: list(said.rooms, "rooms").map(roomFrom),
    walker: {
      eyeHeightM: finite(walker.eye_height_m, "eye_height_m"),
      heightM: finite(walker.height_m, "height_m"),
      radiusM: finite(walker.radius_m, "radius_m"),
    },
    warnings: list(said.warnings, "warnings").map((one) => words(one, "warning")),
  };
}

function modelFile(value: unknown, where: string): ModelFile {
  const said = fields(value, where);
  const url = words(said.url, `${where}.url`);
  return { url, etag: words(said.etag, `${where}.etag`), triangles: whole(said.triangles, `${where}.triangles`) };
}

function storeyFrom(value: unknown): Storey {
  const said = fields(value, "storey");
  const floor = list(said.floor, "floor").flatMap((tile) => {
    const numbers = list(tile, "floor").map((number) => finite(number, "floor"));
    if (numbers.length !== 5) throw new MessageError(`a piece of floor has five numbers, not ${numbers.length}`);
    return numbers;
  });
  return { name: words(said.name, "storey.name"), floorZ: finite(said.floor_z_m, "floor_z_m"), floor: Float32Array.from(floor) };
}

function roomFrom(value: unknown): Room {
  const said = fields(value, "room");
  return {
    name: words(said.name, "room.name"),
    storey: whole(said.storey, "room.storey"),
    centre: triple(said.centre, "room.centre"),
    areaM2: finite(said.area_m2, "room.area_m2"),
    reason: said.reachable === true ? "" : words(said.reason, "room.reason") || "not reachable on foot",
  };
}

export interface ImportanceFile extends Omit<ImportanceState, "data"> {
  readonly url: string;
}

/** Returns what importance.json says. @throws MessageError. */
export function importanceFrom(value: unknown): ImportanceFile {
  const said = fields(value, "importance.json");
  const shape = triple(said.shape, "shape");
  const voxels = shape[0] * shape[1] * shape[2];
  if (!(voxels >= 1 && voxels <= MAX_VOXELS)) throw new MessageError(`a volume of ${voxels} voxels is not taken`);
  const channels = list(said.channels, "channels").map(channelFrom);
  if (channels.length !== 4) throw new MessageError(`a volume has four channels, not ${channels.length}`);
  return {
    origin: triple(said.origin, "origin"),
    voxelM: finite(said.voxel_size_m, "voxel_size_m"),
    shape,
    channels: channels as [Channel, Channel, Channel, Channel],
    revision: words(said.revision_ns, "revision_ns"),
    url: words(said.url, "url"),
  };
}

function channelFrom(value: unknown): Channel {
  const said = fields(value, "channel");
  const name = words(said.name, "channel.name");
  if (!CHANNEL_NAMES.has(name)) throw new MessageError(`no channel is called ${name.slice(0, 40)}`);
  return { name: name as ChannelName, low: finite(said.low, "channel.low"), high: finite(said.high, "channel.high") };
}

/** Returns the volume. @throws MessageError where its size is not what its description says. */
export function volumeFrom({ url: _, ...file }: ImportanceFile, bytes: ArrayBuffer): ImportanceState {
  const expected = 4 * file.shape[0] * file.shape[1] * file.shape[2];
  if (bytes.byteLength !== expected) throw new MessageError(`${bytes.byteLength} bytes of volume, not ${expected}`);
  return { ...file, data: new Uint8Array(bytes) };
}
