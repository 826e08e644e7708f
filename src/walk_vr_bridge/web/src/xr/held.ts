// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** A keypoint in a hand: moved by the hand itself when near, along the level of its floor when by ray. */

import { Vector3 } from "three";
import type { Actions } from "../client/actions";
import type { Quat, Vec3 } from "../client/state";
import { headingOf } from "../scene/axes";
import type { Overlay } from "../scene/overlay";
import type { Stage } from "../scene/stage";
import type { HandInput } from "./input";

/** A ray that is flatter than this to the floor moves a keypoint at a fixed distance instead of along the floor. */
const STEEP = 0.12;
const FAR_M = 60;

export class Held {
  id: number | null = null;
  overlay: Overlay | null = null;
  private near = false;
  private readonly offset = new Vector3();
  private readonly at = new Vector3();
  private readonly shown = new Vector3();
  private distance = 0;
  private level = 0;
  private turned = 0;
  private heading = 0;
  private moved = false;

  constructor(
    private readonly stage: Stage,
    private readonly actions: Actions,
  ) {}

  /** Takes hold of a keypoint, at the distance it was picked at [m of the room]. */
  take(hand: HandInput, id: number, overlay: Overlay, near: boolean, distance: number): void {
    const keypoint = this.stage.store.state.keypoints.find((one) => one.id === id);
    if (!keypoint) return;
    const { place } = overlay;
    this.id = id;
    this.overlay = this.stage.touched = overlay;
    this.near = near;
    this.moved = false;
    this.distance = distance / place.scale;
    const [x, y, z] = keypoint.position;
    this.at.set(x, y, z);
    this.level = z - place.belowEyeM;
    this.offset.copy(this.at).sub(place.toMap(hand.anchor, POINT));
    const [qx, qy, qz, qw] = keypoint.quat;
    this.heading = headingOf(qx, qy, qz, qw);
    this.turned = place.heading(hand.turn);
    if (!near) this.keepRayOffset(hand);
    this.actions.grab(id);
  }

  /** Follows the hand; sends previews, but none of where it lets go: the planner would answer it before the release. */
  follow(hand: HandInput): void {
    if (this.id === null || !this.overlay) return;
    const { place } = this.overlay;
    BEFORE.copy(this.at);
    if (this.near) this.at.copy(place.toMap(hand.anchor, POINT)).add(this.offset);
    else this.followRay(hand);
    if (!Number.isFinite(this.at.x + this.at.y + this.at.z)) this.at.copy(BEFORE);
    // A trembling hand is no move: half a centimetre of the building.
    if (!this.moved && BEFORE.distanceTo(this.at) < 0.005) return;
    this.moved = true;
    if (hand.trigger.down) this.actions.drag(this.id, this.place(), this.quat(hand));
  }

  /** Where it is now, in the room. */
  inRoom(out: Vector3): Vector3 {
    if (!this.overlay) return out;
    this.shown.copy(this.at).setZ(this.at.z - this.overlay.place.belowEyeM);
    return this.overlay.place.toRoom(this.shown, out);
  }

  /** Puts it down: asks the planner, which may refuse. */
  release(hand: HandInput): void {
    const id = this.drop();
    if (id === null) return;
    if (this.moved) void this.actions.release(id, this.place(), this.quat(hand));
    else this.actions.cancel(id);
  }

  /** Throws it away. */
  remove(): void {
    const id = this.drop();
    if (id === null) return;
    this.actions.cancel(id);
    void this.actions.remove(id);
  }

  cancel(): void {
    const id = this.drop();
    if (id !== null) this.actions.cancel(id);
  }

  private drop(): number | null {
    const { id } = this;
    this.id = null;
    this.overlay = null;
    return id;
  }

  private place(): Vec3 {
    return [this.at.x, this.at.y, this.at.z];
  }

  /** A near hand turns it, too. */
  private quat(hand: HandInput): Quat | null {
    if (!this.near || !this.overlay) return null;
    const heading = this.heading + this.overlay.place.heading(hand.turn) - this.turned;
    return [0, 0, Math.sin(heading / 2), Math.cos(heading / 2)];
  }

  private keepRayOffset(hand: HandInput): void {
    this.offset.set(0, 0, 0);
    this.followRay(hand, POINT);
    this.offset.copy(this.at).sub(POINT);
  }

  private followRay(hand: HandInput, out = this.at): void {
    if (!this.overlay) return;
    const { origin, direction } = this.overlay.place.rayToMap(hand.ray);
    const along = (this.level - origin.z) / direction.z;
    const level = Math.abs(direction.z) > STEEP && along > 0 && along < FAR_M;
    if (level) this.distance = along;
    out.copy(origin).addScaledVector(direction, this.distance);
    out.z += this.overlay.place.belowEyeM;
    if (out === this.at) out.add(this.offset);
  }
}

const POINT = new Vector3();
const BEFORE = new Vector3();
