// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Group, type Plane } from "three";
import type { Keypoint } from "../client/state";
import { MapView } from "./mapview";
import { Numbers } from "./numbers";
import { PathView } from "./pathview";
import { Pins, type Showing } from "./pins";
import { Place } from "./place";
import type { PathTube } from "./tube";
import { makeWalker } from "./walker";

/** All that is drawn over one showing of the building: keypoints, path, map and the figure that plays the tour. */
export class Overlay {
  readonly place: Place;
  readonly pins: Pins;
  readonly numbers: Numbers;
  readonly path: PathView;
  readonly map: MapView;
  readonly walker = makeWalker(1.6);
  /** Radius of a keypoint's ball in the map [m]. */
  size = 0;

  /**
   * @param planes what cuts all but the path, and what cuts the path.
   * @param belowEyeM how far under the eye keypoints are drawn.
   * @param pathBelowEyeM how far under the eye the path is drawn.
   */
  constructor(
    name: "full" | "miniature",
    group: Group,
    tube: PathTube,
    [planes, pathPlanes]: [Plane[], Plane[]],
    belowEyeM: number,
    pathBelowEyeM: number,
  ) {
    this.place = new Place(name, group, belowEyeM);
    this.numbers = new Numbers(name === "miniature");
    this.pins = new Pins(1.6 - belowEyeM);
    this.path = new PathView(tube, pathPlanes, name === "miniature" ? 0.22 : 0);
    this.map = new MapView(planes);
    const lowered = new Group();
    lowered.position.z = -belowEyeM;
    lowered.add(this.pins.group, this.numbers.mesh);
    this.path.group.position.z = -pathBelowEyeM;
    group.add(lowered, this.path.group, this.map.group, this.walker);
  }

  setSize(radiusM: number): void {
    if (radiusM === this.size) return;
    this.size = radiusM;
    this.pins.setSize(radiusM);
    this.numbers.setSize(radiusM);
    this.path.setRadius(radiusM * 0.3);
  }

  update(
    keypoints: readonly Keypoint[],
    showing: (keypoint: Keypoint) => Showing,
    hover: number | null,
    chosen: number | null,
  ): void {
    this.pins.update(keypoints, showing, hover, chosen);
    this.numbers.update(keypoints, showing);
  }

  /** Puts the figure where the walker's eye is. */
  walk(position: Float32Array, heading: number, eyeM: number): void {
    this.walker.visible = true;
    this.walker.position.set(position[0], position[1], position[2] - eyeM);
    this.walker.rotation.set(0, 0, heading);
  }
}
