// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Matrix4, Vector3 } from "three";
import type { Actions } from "../client/actions";
import type { Store } from "../client/store";
import { SENTENCE_TIMES, type Stage, type StageMode } from "../scene/stage";
import type { View } from "../scene/view";
import { AtHand } from "./at_hand";
import { Carry } from "./carry";
import { Comfort } from "./comfort";
import { Handler, type HandlerWorld } from "./handler";
import { type HandInput, Inputs } from "./input";
import { Knobs } from "./knobs";
import { HandLook } from "./looks";
import type { PanelPort } from "./panelport";
import { Rider } from "./rider";
import { Rig } from "./rig";
import { Travel } from "./travel";

/** The headset: both hands at work in a room with the building around and the miniature at hand. */
export class XrRoom implements HandlerWorld {
  readonly inputs: Inputs;
  readonly rig: Rig;
  readonly travel: Travel;
  readonly rider: Rider;
  readonly comfort = new Comfort();
  readonly knobs: Knobs;
  readonly handlers: readonly [Handler, Handler];
  private readonly looks = new Map<HandInput, HandLook>();
  private readonly atHand: AtHand;
  private readonly carry = new Carry();
  private carriers = 0;
  private before: StageMode = "model";
  private inside = false;
  private settled = false;

  constructor(
    private readonly view: View,
    readonly stage: Stage,
    private readonly store: Store,
    readonly actions: Actions,
    readonly panel: PanelPort | null,
  ) {
    const { bin, miniature } = stage;
    this.rig = new Rig(view, miniature, panel ? [bin.group, panel.group] : [bin.group]);
    this.atHand = new AtHand(view, stage, panel);
    this.knobs = new Knobs(stage);
    this.travel = new Travel(stage, this.rig, this.comfort);
    this.rider = new Rider(stage, store, actions, this.rig, this.travel, this.comfort);
    this.inputs = new Inputs(view.renderer.xr, view.rig, (hand, target, grip, joints) => {
      this.looks.get(hand)?.wear(target, grip, joints);
    });
    const [left, right] = this.inputs.both;
    for (const hand of this.inputs.both) this.looks.set(hand, new HandLook(hand));
    this.handlers = [new Handler(left, this), new Handler(right, this)];
    view.camera.add(this.comfort.mesh);
    view.scene.add(this.travel.teleport.group);
    if (panel) view.scene.add(panel.group);
    this.show(false);
    view.onFrame((seconds) => this.update(seconds));
  }

  /** A session has begun, or ended. */
  setInside(inside: boolean): void {
    if (inside === this.inside) return;
    this.inside = inside;
    this.settled = false;
    if (inside) this.before = this.stage.mode;
    else for (const handler of this.handlers) handler.letGo();
    this.rider.stop();
    this.show(inside);
    this.stage.setMode(inside ? "room" : this.before);
    if (!inside) this.view.rig.position.set(0, 0, 0);
    if (!inside) this.view.rig.rotation.set(0, 0, 0);
  }

  beginAim(hand: HandInput): void {
    this.travel.beginAim(hand);
  }

  /** Puts miniature, bin and panel up around the user; the panel on the side of the weaker hand, if there is room. */
  bringToHand(): void {
    this.atHand.bring(this.store.state.settings.hand === "right" ? 1 : -1);
  }

  /** While the tour carries the user, nothing hangs in front of the eyes. */
  private clearTheWay(clear: boolean): void {
    this.stage.miniature.group.visible = !clear;
    this.stage.bin.group.visible = !clear;
    if (this.panel) this.panel.group.visible = !clear;
  }

  private show(visible: boolean): void {
    this.knobs.group.visible = visible;
    if (this.panel) this.panel.group.visible = visible;
    this.stage.bin.group.visible = visible;
  }

  private update(seconds: number): void {
    if (!this.inside || !this.view.presenting) return;
    this.inputs.update();
    if (!this.settled) this.settle();
    // A button that stops the ride does nothing else.
    const carried = this.rider.carries;
    this.travel.update(this.inputs, this.store.state.settings, seconds);
    if (!carried) this.buttons();
    this.rider.update(this.inputs, carried, seconds);
    if (!carried) for (let i = 0; i < 2; i++) this.handlers[i].update();
    if (carried && this.rider.ride.phase === "strayed") {
      this.tell("You have left the tour. A or X, or Play on the panel, leads you back.", 6);
    }
    this.clearTheWay(this.rider.carries);
    this.carryMiniature();
    this.showHands();
    this.knobs.update();
    this.panel?.update(seconds);
    this.comfort.update(seconds);
  }

  /** The first frames: the user stands in the building, everything is at hand. */
  private settle(): void {
    const { building } = this.store.state;
    if (!building || !this.stage.models || this.view.eye.y === 0) return;
    const [x, y, z] = building.start;
    this.rig.headTo(x, z, -y);
    this.bringToHand();
    this.explain();
    this.settled = true;
  }

  private explain(): void {
    const bare = this.inputs.left.bare || this.inputs.right.bare;
    const hands = "Pinch a keypoint to move it, the model to carry it; pinch at nothing to go there.";
    const sticks = "The trigger moves keypoints, squeezing carries the model. A or X plays, B or Y undoes, the stick goes.";
    this.tell(bare ? hands : sticks, 12);
  }

  /** Says something in front of the user, over what is at hand. */
  tell(sentence: string, seconds: number): void {
    this.view.camera.getWorldDirection(AHEAD);
    AHEAD.y = 0;
    AT.copy(this.view.eye).addScaledVector(AHEAD.normalize(), 0.9);
    this.stage.nameNote.show(sentence, AT, seconds, SENTENCE_TIMES);
  }

  /** A or X of the stronger hand plays and pauses, B or Y undoes; of the weaker one: everything to hand, redo. */
  private buttons(): void {
    const strong = this.inputs.of(this.store.state.settings.hand);
    const weak = this.inputs.other(strong);
    if (strong.first.pressed) this.rider.toggle();
    if (strong.second.pressed) void this.actions.undo();
    if (weak.first.pressed) this.bringToHand();
    if (weak.second.pressed) void this.actions.redo();
  }

  private carryMiniature(): void {
    const left = this.handlers[0];
    const right = this.handlers[1];
    const carriers = (left.doing === "carry" ? 1 : 0) + (right.doing === "carry" ? 2 : 0);
    const { group } = this.stage.miniature;
    if (carriers !== this.carriers) this.takeMiniature(carriers);
    this.carriers = carriers;
    if (carriers === 0) return;
    if (carriers === 3) this.carry.both(left.hand.anchor, right.hand.anchor, this.clampFactor, POSE);
    else this.carry.one((carriers === 1 ? left : right).hand.grip, POSE);
    this.stage.miniature.setWorldMatrix(POSE);
    group.updateMatrixWorld(true);
  }

  private takeMiniature(carriers: number): void {
    const [left, right] = this.handlers;
    const { group } = this.stage.miniature;
    this.startScale = this.stage.miniature.scale;
    if (carriers === 3) this.carry.beginTwo(group.matrixWorld, left.hand.anchor, right.hand.anchor);
    else if (carriers) this.carry.beginOne(group.matrixWorld, (carriers === 1 ? left : right).hand.grip);
  }

  private startScale = 1;
  private readonly clampFactor = (factor: number): number =>
    this.stage.miniature.clampScale(this.startScale * factor) / this.startScale;

  private showHands(): void {
    const left = this.handlers[0];
    const right = this.handlers[1];
    this.stage.hover = left.held.id ?? right.held.id ?? right.pick.id ?? left.pick.id;
    this.knobs.hover = right.knob ?? left.knob;
    for (let i = 0; i < 2; i++) {
      const { hand, reach } = this.handlers[i];
      const lit = reach < Infinity;
      this.looks.get(hand)?.update(lit ? Math.max(reach, 0.02) : 0.6, lit);
    }
    if (left.doing !== "keypoint" && right.doing !== "keypoint") this.stage.bin.invite(false);
    this.nameHovered(right.pick.id !== null ? right : left);
  }

  private nameHovered(handler: Handler): void {
    const { id, overlay } = handler.pick;
    const { nameNote } = this.stage;
    if (id === null || !overlay) return;
    const keypoints = this.store.state.keypoints;
    for (let i = 0; i < keypoints.length; i++) {
      const keypoint = keypoints[i];
      if (keypoint.id !== id) continue;
      overlay.place.shown(keypoint.position, AT);
      AT.y += overlay.size * overlay.place.scale * 4.2;
      nameNote.show(keypoint.unreachable || keypoint.label, AT, 0.4);
      return;
    }
  }
}

const AHEAD = new Vector3();
const AT = new Vector3();
const POSE = new Matrix4();
