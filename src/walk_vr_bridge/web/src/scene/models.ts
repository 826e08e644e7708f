// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** Fetches the building's two files and makes models of them; only where their content has changed. */

import type { BuildingState, ModelFile } from "../client/state";
import type { Bvh } from "./bvh";
import { readGlb } from "./glb";
import { buildBvh, type BuildingModel, buildModel, buildPanes } from "./model";

/** Shorter edges are not drawn [m]: of the full scale, and of the miniature, where they would be a haze. */
const LEAST_EDGE_M = 0.06;
const LEAST_EDGE_MINIATURE_M = 0.2;

export interface Models {
  readonly full: BuildingModel;
  readonly miniature: BuildingModel;
  readonly bvh: Bvh;
  /** What a walker can touch: also the glass. */
  readonly obstacles: readonly Bvh[];
}

/** Returns the models. @throws Error with a sentence where a file cannot be had. */
export async function loadModels(building: BuildingState): Promise<Models> {
  const [fullFile, miniatureFile] = await Promise.all([read(building.model), read(building.miniature)]);
  const meshes = readGlb(fullFile);
  const bvh = buildBvh(meshes);
  return {
    full: buildModel(meshes, LEAST_EDGE_M),
    miniature: buildModel(readGlb(miniatureFile), LEAST_EDGE_MINIATURE_M),
    bvh,
    obstacles: [bvh, buildPanes(meshes)],
  };
}

async function read(file: ModelFile): Promise<ArrayBuffer> {
  const answer = await fetch(file.url);
  if (!answer.ok) throw new Error(`${file.url} answered ${answer.status}`);
  return answer.arrayBuffer();
}
