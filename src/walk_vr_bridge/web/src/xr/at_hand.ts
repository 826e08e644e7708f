// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Vector3 } from "three";
import type { Bvh } from "../scene/bvh";
import { MINIATURE_M } from "../scene/miniature";
import type { Stage } from "../scene/stage";
import type { View } from "../scene/view";
import type { PanelPort } from "./panelport";
import { BEFORE_WALL_M, bringIntoSight, inSight } from "./sight";

/** Where things are put up around the user, in front of the head's heading: right, up from the floor, ahead [m]. */
type Offset = readonly [right: number, up: number, ahead: number];
const MINIATURE_AT: Offset = [0, 0.82, 0.62];
const BIN_AT: Offset = [0.44, 0.92, 0.46];
/** The panel beside the miniature; for who faces a wall, straight aside. */
const PANEL_AT: readonly Offset[] = [
  [-0.58, 1.25, 0.52],
  [-0.64, 1.25, -0.1],
];
/** As parts of its way from the eye: where no place is free the panel is tried nearer. */
const NEARER = [1, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4];

/** Puts up what the user works with, none of it behind a wall of the building at full scale. */
export class AtHand {
  constructor(
    private readonly view: View,
    private readonly stage: Stage,
    private readonly panel: PanelPort | null,
  ) {}

  /** Puts miniature, bin and panel up; `side` is 1 where the panel belongs to the left, -1 where to the right. */
  bring(side: 1 | -1): void {
    this.view.camera.getWorldDirection(AHEAD);
    AHEAD.y = 0;
    AHEAD.normalize();
    const heading = Math.atan2(-AHEAD.x, -AHEAD.z);
    const { bin, miniature } = this.stage;
    miniature.placeAt(this.seen(MINIATURE_AT, side), heading, MINIATURE_M / this.longest());
    // The bin hangs where the panel does not.
    const taken = this.panel ? this.placePanel(this.panel, side) : side;
    bin.group.position.copy(this.seen(BIN_AT, taken));
  }

  /** Returns the side on which the panel has found its place. */
  private placePanel(panel: PanelPort, side: 1 | -1): 1 | -1 {
    for (const part of NEARER) {
      for (const offset of PANEL_AT) {
        for (const one of [side, -side] as (1 | -1)[]) {
          this.turnPanel(panel, AT.lerpVectors(this.view.eye, this.around(offset, one), part));
          if (this.seesWhole(panel)) return one;
        }
      }
    }
    this.turnPanel(panel, this.seen(PANEL_AT[0], side));
    return side;
  }

  private turnPanel({ group }: PanelPort, at: Vector3): void {
    const { eye } = this.view;
    group.position.copy(at);
    group.rotation.set(0, Math.atan2(eye.x - at.x, eye.z - at.z), 0);
  }

  /** Whether no wall hides the panel's middle or one of its corners. */
  private seesWhole({ group, widthM, heightM }: PanelPort): boolean {
    const { eye } = this.view;
    if (!inSight(this.walls, eye, group.position, BEFORE_WALL_M)) return false;
    for (const x of [-widthM / 2, widthM / 2]) {
      for (const y of [-heightM / 2, heightM / 2]) {
        const corner = CORNER.set(x, y, 0).applyEuler(group.rotation).add(group.position);
        if (!inSight(this.walls, eye, corner)) return false;
      }
    }
    return true;
  }

  private seen(offset: Offset, side: 1 | -1): Vector3 {
    return bringIntoSight(this.walls, this.view.eye, AT.copy(this.around(offset, side)));
  }

  private get walls(): Bvh | undefined {
    return this.stage.models?.bvh;
  }

  private longest(): number {
    const size = this.stage.bounds.getSize(new Vector3());
    return Math.max(size.x, size.y, size.z, 0.1);
  }

  private around([right, up, ahead]: Offset, side: 1 | -1): Vector3 {
    const { eye, rig } = this.view;
    PLACE.copy(eye).addScaledVector(AHEAD, ahead);
    PLACE.x -= AHEAD.z * right * side;
    PLACE.z += AHEAD.x * right * side;
    // Lower for who sits: things keep their distance under the eyes.
    PLACE.y = rig.position.y + up * Math.min(1, Math.max(0.5, (eye.y - rig.position.y) / 1.6));
    return PLACE;
  }
}

const AHEAD = new Vector3();
const PLACE = new Vector3();
const AT = new Vector3();
const CORNER = new Vector3();
