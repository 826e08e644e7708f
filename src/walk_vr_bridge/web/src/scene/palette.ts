// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Color } from "three";
import type { GroupName, Part } from "./glb";

const BY_GROUP: Readonly<Record<GroupName, string>> = {
  structure: "#ece7df",
  ceiling: "#f4f2ee",
  glass: "#a9d3e6",
  stair: "#c8ab84",
  door: "#b98a5c",
  furniture: "#9fb0ba",
};

const BY_CLASS: Readonly<Record<string, string>> = {
  IfcSlab: "#d9d0c3",
  IfcRoof: "#b9776a",
  IfcColumn: "#c3c7cb",
  IfcBeam: "#c3c7cb",
  IfcRailing: "#8d949b",
  IfcCovering: "#dcd3c6",
};

/** Furniture comes in calm tones; one name always has the same. */
const FURNITURE = ["#8fa6b5", "#b5a58f", "#9db09a", "#b0958f", "#8f9aa6", "#c2b38a"];
const PLANT = /tree|plant|shrub|bush|hedge|palm|baum|pflanze|strauch/i;
const PLANT_COLOUR = "#7fa374";

/** Returns the colour of a part of the building in linear light. */
export function colourOfPart(group: GroupName, part: Part, target: Color): Color {
  const byClass = BY_CLASS[part.kind];
  if (byClass) return target.set(byClass);
  if (PLANT.test(part.name)) return target.set(PLANT_COLOUR);
  if (group === "furniture") return target.set(FURNITURE[hash(part.name) % FURNITURE.length]);
  return target.set(BY_GROUP[group]);
}

function hash(text: string): number {
  const word = text.replace(/[\d:_.\s-]+$/, "");
  let value = 0;
  for (let i = 0; i < word.length; i++) value = (value * 31 + word.charCodeAt(i)) >>> 0;
  return value;
}

export const CAP_COLOUR = "#39424d";
export const EDGE_COLOUR = "#3c4650";
export const SKY_COLOUR = "#dfe8ef";
export const GROUND_COLOUR = "#c9d2d6";

/** Colours of the things one edits. */
export const KEYPOINT = {
  plain: "#ffb02e",
  start: "#2fbf71",
  end: "#e5484d",
  locked: "#7f8ea3",
  unreachable: "#8b2635",
  hover: "#fff3c4",
  chosen: "#3ea6ff",
  pending: "#ffd98a",
} as const;
export const PATH_COLOUR = "#1f8fff";
