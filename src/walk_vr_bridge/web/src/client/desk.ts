// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Everything that edits keypoints: grab, drag, release, and the changes; refusals are shown where they happened. */

import type { EditResult } from "./answers";
import { gesture, type Edit } from "./edits";
import { Hand } from "./hand";
import { KeypointView } from "./keypoint_view";
import { Outbox, type Outcome } from "./outbox";
import type { Quat, Vec3 } from "./state";
import type { Store } from "./store";
import { byPlace } from "./words";
import type { Clock } from "./wire";

const REFUSALS_KEPT = 8;
/** Refusals of a keypoint on its way within this time are one: a drag along a wall is refused 90 times a second. */
const SAME_REFUSAL_MS = 2500;

export class EditDesk {
  readonly view: KeypointView;
  private readonly outbox: Outbox;
  private readonly hands = new Map<number, Hand>();
  private serial = 0;
  private readonly port;

  constructor(
    private readonly store: Store,
    send: (message: Record<string, unknown>) => boolean,
    private readonly clock: Clock,
  ) {
    this.view = new KeypointView(store);
    const unconfirmed = (count: number): void => store.patch("connection", { unconfirmed: count });
    this.outbox = new Outbox({ send, unconfirmed }, clock);
    this.port = { send, next: () => this.outbox.next() };
  }

  /** Takes hold of a keypoint. */
  grab(id: number): void {
    this.hands.get(id)?.letGo();
    this.hands.set(id, new Hand(id, this.port, this.clock));
  }

  /** Moves a keypoint that is held; shown at once. */
  drag(id: number, position: Vec3, quat: Quat | null = null): void {
    const hand = this.hands.get(id);
    if (!hand) return;
    hand.drag(position, quat ?? this.quatOf(id));
    this.view.move(id, position, quat, -1);
  }

  /** Puts a keypoint down; resolves once the planner has answered. */
  release(id: number, position: Vec3, quat: Quat | null = null): Promise<Outcome> {
    this.hands.get(id)?.letGo();
    this.hands.delete(id);
    const label = this.outbox.next();
    this.view.move(id, position, quat, label);
    return this.settle({ ...gesture("MOUSE_UP", id), position, quat: quat ?? this.quatOf(id) }, label);
  }

  /** Ends a drag and leaves the keypoint where it was. */
  cancel(id: number): void {
    const hand = this.hands.get(id);
    if (!hand) return;
    hand.letGo();
    this.hands.delete(id);
    this.view.putBack(id, null);
    const server = this.store.state.keypoints.find((keypoint) => keypoint.id === id);
    // A drag without a release leaves the planner's preview standing: going back is a release at the old place.
    if (server) void this.outbox.post({ ...gesture("MOUSE_UP", id), position: server.position, quat: server.quat });
  }

  holds(id: number): boolean {
    return this.hands.has(id);
  }

  /** Makes one of the changes; resolves once the planner has answered. */
  perform(edit: Edit): Promise<Outcome> {
    return this.settle(edit, this.outbox.next());
  }

  answered(result: EditResult): void {
    if (result.betterOrderSavesM !== null) {
      this.store.patch("offer", { betterOrderSavesM: result.betterOrderSavesM });
    }
    if (this.outbox.answer(result) || result.outcome !== "refused") return;
    // A grab or a drag: the keypoint stays in the hand, where it may come to a better place, unless it is not ours.
    const id = result.keypoint;
    const shown = this.store.state.keypoints.find((keypoint) => keypoint.id === id);
    this.refuse(id, shown?.position ?? null, result.reason, true);
  }

  /** Sends what waits, takes hold again of what is held. */
  reconnected(): void {
    for (const hand of this.hands.values()) hand.grab();
    this.outbox.reconnected();
  }

  refuse(keypoint: number | null, place: Vec3 | null, why: string, preview = false): void {
    const atMs = this.clock.now();
    const { keypoints, refusals } = this.store.state;
    const reason = byPlace(why, keypoints);
    const last = refusals.at(-1);
    const recent = last && last.keypoint === keypoint && atMs - last.atMs < SAME_REFUSAL_MS;
    if (recent && (preview || last.reason === reason)) return;
    const refusal = { serial: ++this.serial, keypoint, place, reason, atMs };
    // The word about a release takes the place of what was said on the way there.
    const others = recent && keypoint !== null ? refusals.slice(0, -1) : refusals;
    this.store.set("refusals", [...others, refusal].slice(-REFUSALS_KEPT));
  }

  /** A keypoint that is only moved keeps its look: a message without one would turn it ahead. */
  private quatOf(id: number): Quat | null {
    return this.store.state.keypoints.find((keypoint) => keypoint.id === id)?.quat ?? null;
  }

  private async settle(edit: Edit, label: number): Promise<Outcome> {
    const outcome = await this.outbox.post(edit, label);
    const moved = edit.event === "MOUSE_UP" ? edit.keypoint : null;
    if (outcome.outcome === "accepted") {
      if (moved !== null) this.view.accept(moved, label, outcome.revision);
      return outcome;
    }
    const shown = moved === null ? null : this.view.putBack(moved, label);
    if (goneAnyway(edit, outcome, this.view)) return { ...outcome, outcome: "accepted" } as Outcome;
    if (outcome.outcome !== "followed") this.refuse(edit.keypoint, shown ?? edit.position, outcome.reason);
    return outcome;
  }
}

/** A deletion that is sent again after a lost connection finds its keypoint gone: it is what was wanted. */
function goneAnyway(edit: Edit, outcome: Outcome, view: KeypointView): boolean {
  return (
    edit.change === "remove" && outcome.outcome === "refused" && edit.keypoint !== null && !view.has(edit.keypoint)
  );
}
