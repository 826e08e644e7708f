// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The keypoints as this client shows them: the server's, with those it moves itself where its hand has them. */

import { includes } from "./answers";
import type { KeypointsMessage } from "./markers";
import type { Keypoint, Quat, Vec3 } from "./state";
import type { Store } from "./store";

interface Moved {
  position: Vec3;
  quat: Quat | null;
  /** Which edit it is that this place was last sent with. */
  label: number;
  /** The revision that will show it; empty while no answer has come. */
  revision: string;
}

export class KeypointView {
  private server: KeypointsMessage = { revision: "", keypoints: [] };
  private readonly moved = new Map<number, Moved>();

  constructor(private readonly store: Store) {}

  get revision(): string {
    return this.server.revision;
  }

  /** Takes the server's word; what it includes is no longer this client's to show. */
  receive(message: KeypointsMessage): void {
    this.server = message;
    const ids = new Set(message.keypoints.map(({ id }) => id));
    for (const [id, { revision }] of this.moved) {
      if (!ids.has(id) || (revision && includes(message.revision, revision))) this.moved.delete(id);
    }
    this.show();
  }

  has(id: number): boolean {
    return this.server.keypoints.some((keypoint) => keypoint.id === id);
  }

  ids(): ReadonlySet<number> {
    return new Set(this.server.keypoints.map(({ id }) => id));
  }

  /** Shows a keypoint where the hand has it. */
  move(id: number, position: Vec3, quat: Quat | null, label: number): void {
    this.moved.set(id, { position, quat, label, revision: "" });
    this.show();
  }

  /** The move of this label was accepted and is, or will be, in `revision`. */
  accept(id: number, label: number, revision: string): void {
    const moved = this.moved.get(id);
    if (moved?.label !== label) return;
    if (includes(this.server.revision, revision)) this.putBack(id, label);
    else moved.revision = revision;
  }

  /** The move of this label is not to be: the keypoint is shown where the server has it. Returns where it was shown. */
  putBack(id: number, label: number | null): Vec3 | null {
    const moved = this.moved.get(id);
    if (!moved || (label !== null && moved.label !== label)) return null;
    this.moved.delete(id);
    this.show();
    return moved.position;
  }

  private show(): void {
    const shown = this.server.keypoints.map((keypoint): Keypoint => {
      const moved = this.moved.get(keypoint.id);
      if (!moved) return keypoint;
      return { ...keypoint, position: moved.position, quat: moved.quat ?? keypoint.quat, pending: true };
    });
    this.store.set("keypoints", shown);
  }
}
