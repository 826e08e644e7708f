// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A hand that holds a keypoint: drags at most 90 times a second, the newest wins, and says that it is still there. */

import { editMessage, gesture } from "./edits";
import type { Quat, Vec3 } from "./state";
import type { Clock } from "./wire";

export const DRAG_MS = 1000 / 90;
/** The planner takes a keypoint back after 10 s of silence. */
const ALIVE_MS = 3000;

export interface HandPort {
  send(message: Record<string, unknown>): boolean;
  next(): number;
}

export class Hand {
  private position: Vec3 | null = null;
  private quat: Quat | null = null;
  private sentMs = -Infinity;
  private trailing = 0;
  private alive = 0;
  private held = true;

  constructor(
    readonly keypoint: number,
    private readonly port: HandPort,
    private readonly clock: Clock,
  ) {
    this.grab();
  }

  /** Says, also after a reconnection, that the keypoint is held. */
  grab(): void {
    this.port.send(editMessage(gesture("MOUSE_DOWN", this.keypoint), this.port.next()));
    this.stayAlive();
  }

  drag(position: Vec3, quat: Quat | null): void {
    this.position = position;
    this.quat = quat;
    if (this.trailing) return;
    const wait = this.sentMs + DRAG_MS - this.clock.now();
    if (wait <= 0) this.sendDrag();
    else this.trailing = this.clock.setTimer(() => this.sendDrag(), wait);
  }

  /** Ends the drag without a word to the planner: the release is an edit that is confirmed. */
  letGo(): void {
    this.held = false;
    this.clock.clearTimer(this.trailing);
    this.clock.clearTimer(this.alive);
  }

  private sendDrag(): void {
    this.trailing = 0;
    if (!this.held || !this.position) return;
    this.sentMs = this.clock.now();
    const edit = { ...gesture("POSE_UPDATE", this.keypoint), position: this.position, quat: this.quat };
    this.port.send(editMessage(edit, this.port.next()));
    this.stayAlive();
  }

  private stayAlive(): void {
    this.clock.clearTimer(this.alive);
    this.alive = this.clock.setTimer(() => {
      this.port.send(editMessage(gesture("KEEP_ALIVE", this.keypoint), 0));
      this.stayAlive();
    }, ALIVE_MS);
  }
}
