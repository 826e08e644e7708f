// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** What one hand does: hovers, holds a keypoint, carries, cuts, presses. One thing at a time. */

import { Box3, Vector2, Vector3 } from "three";
import type { Actions } from "../client/actions";
import type { Stage } from "../scene/stage";
import { Adding } from "./adding";
import { Held } from "./held";
import type { HandInput } from "./input";
import type { KnobName, Knobs } from "./knobs";
import { meetPanel, type PanelPort } from "./panelport";
import { makePick, type Pick, pickKeypoint } from "./pick";
import { makeMeeting, meetNearest } from "./surface";

export type Doing = "nothing" | "keypoint" | "carry" | "knob" | "panel" | "add" | "aim";

const TICK = { hover: [0.15, 12], grab: [0.5, 30], bin: [0.9, 70], snap: [0.3, 20] } as const;
/** The miniature is at hand within this distance of its box [m]. */
const AT_HAND_M = 0.06;

export interface HandlerWorld {
  readonly stage: Stage;
  readonly actions: Actions;
  readonly knobs: Knobs;
  readonly panel: PanelPort | null;
  /** A bare hand that pinches at nothing. */
  beginAim(hand: HandInput): void;
}

export class Handler {
  doing: Doing = "nothing";
  readonly held: Held;
  readonly adding: Adding;
  readonly pick: Pick = makePick();
  knob: KnobName | null = null;
  /** How far the ray goes to what it is at [m of the room]; Infinity: to nothing. */
  reach = Infinity;
  private readonly at = new Vector2();
  private hovered: number | string | null = null;

  constructor(
    readonly hand: HandInput,
    private readonly world: HandlerWorld,
  ) {
    this.held = new Held(world.stage, world.actions);
    this.adding = new Adding(world.stage, world.actions);
  }

  update(): void {
    if (!this.hand.tracked) {
      this.letGo();
      return;
    }
    if (this.doing === "nothing") this.look();
    if (this.doing === "nothing" && this.hand.trigger.pressed) this.begin();
    else this.proceed();
    if (this.doing === "nothing" && this.hand.squeeze.pressed) this.doing = "carry";
    else if (this.doing === "carry" && !this.hand.squeeze.down && !(this.hand.bare && this.hand.trigger.down)) {
      this.doing = "nothing";
    }
  }

  /** Whether a place of the room lies in the miniature's box, or near it. */
  nearMiniature(point: Vector3): boolean {
    const { stage } = this.world;
    if (!stage.miniature.group.visible) return false;
    BOX.copy(stage.bounds).expandByScalar(AT_HAND_M / stage.inMiniature.place.scale);
    return BOX.containsPoint(stage.inMiniature.place.toMap(point, POINT));
  }

  private look(): void {
    const { hand, world } = this;
    const panelAt = world.panel ? meetPanel(world.panel, hand.ray, this.at) : Infinity;
    pickKeypoint(world.stage, hand, this.pick);
    this.knob = this.pick.near ? null : world.knobs.at(hand);
    if (!this.pick.near && panelAt < this.pick.distance) {
      this.pick.id = null;
      this.knob = null;
    }
    hand.atPanel = panelAt < Infinity && this.pick.id === null;
    world.panel?.point(hand.side, hand.atPanel ? this.at : null);
    if (hand.atPanel && Math.abs(hand.stickY) > 0.2) world.panel?.scroll(hand.side, hand.stickY);
    this.reach = this.pick.id !== null ? this.pick.distance : panelAt;
    const hovered = this.pick.id ?? this.knob;
    if (hovered !== this.hovered && hovered !== null) hand.pulse(...TICK.hover);
    this.hovered = hovered;
  }

  private begin(): void {
    const { hand, world, pick } = this;
    if (!hand.atPanel && this.lookedAt()) {
      hand.pulse(...TICK.grab);
      return;
    }
    if (pick.id !== null && pick.overlay) {
      this.held.take(hand, pick.id, pick.overlay, pick.near, pick.distance);
      this.doing = "keypoint";
    } else if (this.knob) {
      world.knobs.take(hand, this.knob);
      this.doing = "knob";
    } else if (world.panel && meetPanel(world.panel, hand.ray, this.at) < Infinity) {
      const press = world.panel.press(hand.side, this.at);
      this.doing = press === "add" ? "add" : press === "pressed" ? "panel" : "nothing";
    } else if (hand.bare && this.nearMiniature(hand.tip)) this.doing = "carry";
    else if (hand.bare) {
      world.beginAim(hand);
      this.doing = "aim";
    }
    if (this.doing !== "nothing") hand.pulse(...TICK.grab);
  }

  /** After "Look at …" on the panel the trigger says where to; returns whether it was for that. */
  private lookedAt(): boolean {
    const { stage, actions } = this.world;
    const { tool, keypoint } = stage.store.state.selection;
    if (tool !== "lookAt" || keypoint === null) return false;
    if (meetNearest(stage, this.hand, MET)) void actions.lookAt(keypoint, [MET.at.x, MET.at.y, MET.at.z]);
    actions.useTool("edit");
    return true;
  }

  private proceed(): void {
    const { hand, world } = this;
    if (this.doing === "keypoint") this.proceedKeypoint();
    else if (this.doing === "add") this.proceedAdd();
    else if (this.doing === "knob" && this.knob) {
      if (world.knobs.follow(hand, this.knob)) this.snapped();
      if (!hand.trigger.down) this.doing = "nothing";
    } else if (this.doing === "panel") this.proceedPanel();
    else if (this.doing === "aim" && !hand.trigger.down) this.doing = "nothing";
  }

  /** The cut has met a storey: the panel shows it, too. */
  private snapped(): void {
    this.hand.pulse(...TICK.snap);
    this.world.actions.showStorey(this.world.stage.miniature.clip.storey);
  }

  private proceedKeypoint(): void {
    const { hand, held, world } = this;
    held.follow(hand);
    const over = this.overBin(held.inRoom(POINT));
    world.stage.bin.invite(over);
    if (hand.trigger.down) return;
    this.doing = "nothing";
    if (!over) {
      held.release(hand);
      return;
    }
    hand.pulse(...TICK.bin);
    const at = world.stage.bin.group.position;
    POINT.set(at.x, at.y + 0.09, at.z);
    const sentence = hand.bare ? "Deleted. The panel can undo it." : "Deleted. B or Y, or the panel, undoes it.";
    world.stage.nameNote.show(sentence, POINT, 5);
    held.remove();
  }

  private overBin(keypoint: Vector3): boolean {
    const { bin } = this.world.stage;
    return bin.takes(keypoint) || bin.takes(this.hand.tip);
  }

  private proceedAdd(): void {
    const { hand, world } = this;
    this.adding.follow(hand, this.nearMiniature(hand.tip));
    const over = world.panel !== null && meetPanel(world.panel, hand.ray, this.at) < Infinity;
    if (hand.trigger.down) return;
    this.doing = "nothing";
    world.panel?.release(hand.side, null);
    if (over || world.stage.bin.takes(hand.tip)) this.adding.cancel();
    else this.adding.drop();
  }

  private proceedPanel(): void {
    const { hand, world } = this;
    const { panel } = world;
    if (!panel) return;
    const on = meetPanel(panel, hand.ray, this.at) < Infinity;
    panel.point(hand.side, on ? this.at : null);
    if (hand.trigger.down) return;
    panel.release(hand.side, on ? this.at : null);
    this.doing = "nothing";
  }

  /** The hand is lost, or the session ends: what it holds goes back to where it was. */
  letGo(): void {
    if (this.doing === "keypoint") this.held.cancel();
    if (this.doing === "add") this.adding.cancel();
    if (this.doing === "panel") this.world.panel?.release(this.hand.side, null);
    this.doing = "nothing";
    this.pick.id = null;
    this.hand.atPanel = false;
    this.reach = Infinity;
  }
}

const BOX = new Box3();
const MET = makeMeeting();
const POINT = new Vector3();
