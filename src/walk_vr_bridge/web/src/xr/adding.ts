// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from "three";
import type { Actions } from "../client/actions";
import type { Overlay } from "../scene/overlay";
import { KEYPOINT } from "../scene/palette";
import { SENTENCE_TIMES, type Stage } from "../scene/stage";
import type { HandInput } from "./input";
import { makeMeeting, meetBuilding } from "./surface";

const BALL_M = 0.02;
const FLAT = 0.7;

/** A new keypoint on its way from the panel into the miniature or the room: a ball in the hand, put down where it is let go. */
export class Adding {
  private readonly ball: Mesh<SphereGeometry, MeshBasicMaterial>;
  private readonly target = new Vector3();
  private overlay: Overlay | null = null;

  constructor(
    private readonly stage: Stage,
    private readonly actions: Actions,
  ) {
    const look = new MeshBasicMaterial({ color: KEYPOINT.plain, transparent: true, opacity: 0.9 });
    this.ball = new Mesh(new SphereGeometry(1, 16, 12), look);
    this.ball.visible = false;
    stage.view.scene.add(this.ball);
  }

  /** Near the miniature the hand itself says where; else the floor that its ray meets, in the miniature or the room. */
  follow(hand: HandInput, near: boolean): void {
    this.overlay = null;
    this.ball.visible = true;
    this.ball.position.copy(hand.tip);
    this.ball.scale.setScalar(BALL_M);
    if (near) {
      this.overlay = this.stage.inMiniature;
      this.overlay.place.toMap(hand.tip, this.target).z += this.overlay.place.belowEyeM;
    } else if (!this.byRay(hand, this.stage.inMiniature)) this.byRay(hand, this.stage.inFull);
    if (!this.overlay) return;
    const { place, size } = this.overlay;
    this.ball.scale.setScalar(size * place.scale);
    AT.copy(this.target).z -= place.belowEyeM;
    place.toRoom(AT, this.ball.position);
  }

  /** Asks for a keypoint at the place; away from any floor nothing is added, and that is said. */
  drop(): void {
    this.ball.visible = false;
    if (!this.overlay) {
      const sentence = "There is no floor here. Let go over a floor of the building or the miniature.";
      this.stage.refusalNote.show(sentence, this.ball.position, 4, SENTENCE_TIMES);
      return;
    }
    const { x, y, z } = this.target;
    this.stage.touched = this.overlay;
    void this.actions.add([x, y, z]);
  }

  cancel(): void {
    this.ball.visible = false;
    this.overlay = null;
  }

  private byRay(hand: HandInput, overlay: Overlay): boolean {
    if (!meetBuilding(this.stage, overlay, hand, MET) || MET.up < FLAT) return false;
    this.overlay = overlay;
    this.target.copy(MET.at).z += this.stage.eyeHeightM;
    return true;
  }
}

const AT = new Vector3();
const MET = makeMeeting();
