// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { type Group, Matrix4, Quaternion, Vector3, type WebXRManager, type XRHandSpace } from "three";
import type { Hand as Side } from "../client/state";
import { makeRay } from "../scene/place";
import { Button, Flick } from "./button";

/** Pinch begins with thumb and finger this near, and ends this far apart [m]. */
const PINCH_M = 0.018;
const UNPINCH_M = 0.035;
/** How far ahead of a controller's ray origin things are grabbed [m]. */
const TIP_M = 0.04;

/** One hand in the room: a controller, or a bare hand that pinches. Filled once a frame. */
export class HandInput {
  tracked = false;
  bare = false;
  readonly ray = makeRay();
  /** Where near things are grabbed. */
  readonly tip = new Vector3();
  /** What held things follow: the tip of a controller, the knuckle of a bare hand, which stays where it is while it pinches. */
  readonly anchor = new Vector3();
  /** Place and turn of the fist, in the room. */
  readonly grip = new Matrix4();
  readonly turn = new Quaternion();
  readonly trigger = new Button();
  readonly squeeze = new Button();
  readonly first = new Button();
  readonly second = new Button();
  readonly stick = new Button();
  readonly forward = new Flick();
  readonly left = new Flick();
  readonly right = new Flick();
  stickX = 0;
  stickY = 0;
  source: XRInputSource | null = null;
  /** Its ray is on the panel: the stick scrolls there and moves nobody. */
  atPanel = false;
  private readonly buttons = [this.trigger, this.squeeze, this.first, this.second, this.stick] as const;
  private readonly flicks = [this.forward, this.left, this.right] as const;
  private pinching = false;
  /** Select events of sources that have no gamepad. */
  private selecting = false;

  constructor(readonly side: Side) {}

  /** A tick one feels; nothing where the device has no motor. */
  pulse(strength: number, ms: number): void {
    const actuator = this.source?.gamepad?.hapticActuators?.[0] as GamepadHapticActuator & Pulsing | undefined;
    void actuator?.pulse?.(strength, ms);
  }

  connect(source: XRInputSource, target: Group, gripSpace: Group, joints: XRHandSpace): void {
    this.source = source;
    this.target = target;
    this.gripSpace = gripSpace;
    this.joints = joints;
    this.bare = Boolean(source.hand);
  }

  disconnect(source: XRInputSource): void {
    if (this.source !== source) return;
    this.source = null;
    this.tracked = false;
    this.release();
  }

  select(selecting: boolean): void {
    this.selecting = selecting;
  }

  /** Once a frame, after three.js has read the poses and the rig has moved. */
  update(): void {
    const { target, gripSpace, source } = this;
    this.tracked = Boolean(source && target?.visible);
    if (!source || !target || !gripSpace || !this.tracked) {
      this.release();
      return;
    }
    this.ray.origin.setFromMatrixPosition(target.matrixWorld);
    this.turn.setFromRotationMatrix(target.matrixWorld);
    this.ray.direction.set(0, 0, -1).applyQuaternion(this.turn);
    this.grip.copy(gripSpace.visible ? gripSpace.matrixWorld : target.matrixWorld);
    this.tip.copy(this.ray.origin).addScaledVector(this.ray.direction, TIP_M);
    this.anchor.copy(this.tip);
    if (this.bare) this.readPinch();
    this.readButtons(source.gamepad);
  }

  private target: Group | null = null;
  private gripSpace: Group | null = null;
  private joints: XRHandSpace | null = null;

  private readPinch(): void {
    const thumb = this.joints?.joints["thumb-tip"];
    const finger = this.joints?.joints["index-finger-tip"];
    if (!thumb?.visible || !finger?.visible) return;
    THUMB.setFromMatrixPosition(thumb.matrixWorld);
    this.tip.setFromMatrixPosition(finger.matrixWorld);
    const apart = THUMB.distanceTo(this.tip);
    this.pinching = apart < (this.pinching ? UNPINCH_M : PINCH_M);
    this.tip.add(THUMB).multiplyScalar(0.5);
    const knuckle = this.joints?.joints["index-finger-phalanx-proximal"];
    if (knuckle?.visible) this.anchor.setFromMatrixPosition(knuckle.matrixWorld);
  }

  private readButtons(pad: Gamepad | undefined): void {
    const held = this.selecting || (this.bare && this.pinching) ? 1 : 0;
    this.trigger.update(Math.max(held, valueOf(pad, 0)));
    if (this.bare) return;
    this.squeeze.update(valueOf(pad, 1));
    this.stick.update(valueOf(pad, 3));
    this.first.update(valueOf(pad, 4));
    this.second.update(valueOf(pad, 5));
    this.stickX = pad?.axes[2] ?? 0;
    this.stickY = pad?.axes[3] ?? 0;
    this.forward.update(-this.stickY);
    this.left.update(-this.stickX);
    this.right.update(this.stickX);
  }

  private release(): void {
    this.pinching = this.selecting = false;
    this.stickX = this.stickY = 0;
    for (let i = 0; i < this.buttons.length; i++) this.buttons[i].update(0);
    for (let i = 0; i < this.flicks.length; i++) this.flicks[i].update(0);
  }
}

function valueOf(pad: Gamepad | undefined, index: number): number {
  return pad?.buttons[index]?.value ?? 0;
}

interface Pulsing {
  pulse?(strength: number, ms: number): Promise<boolean>;
}

/** Both hands of a session. */
export class Inputs {
  readonly left = new HandInput("left");
  readonly right = new HandInput("right");
  readonly both: readonly [HandInput, HandInput] = [this.left, this.right];

  /** @param onSource called with the groups that follow a source's poses, to hang something visible on. */
  constructor(
    xr: WebXRManager,
    rig: Group,
    onSource: (hand: HandInput, target: Group, grip: Group, joints: XRHandSpace) => void,
  ) {
    for (const index of [0, 1]) {
      const target = xr.getController(index);
      const grip = xr.getControllerGrip(index);
      const joints = xr.getHand(index);
      rig.add(target, grip, joints);
      let hand: HandInput | null = null;
      target.addEventListener("connected", ({ data }) => {
        if (data.handedness === "none") return;
        hand = this.of(data.handedness);
        hand.connect(data, target, grip, joints);
        onSource(hand, target, grip, joints);
      });
      target.addEventListener("disconnected", ({ data }) => hand?.disconnect(data));
      target.addEventListener("selectstart", () => hand?.select(true));
      target.addEventListener("selectend", () => hand?.select(false));
    }
  }

  of(side: Side): HandInput {
    return side === "left" ? this.left : this.right;
  }

  other(hand: HandInput): HandInput {
    return hand === this.left ? this.right : this.left;
  }

  update(): void {
    this.left.update();
    this.right.update();
  }

  /** Whether any button of either hand was pressed in this frame. */
  get anyPressed(): boolean {
    for (let i = 0; i < 2; i++) {
      const hand = this.both[i];
      if (hand.trigger.pressed || hand.squeeze.pressed || hand.first.pressed) return true;
      if (hand.second.pressed || hand.stick.pressed) return true;
    }
    return false;
  }
}

const THUMB = new Vector3();
