// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The foot of the page: play, and where on the way one is. */

import type { Client } from "../client/client";
import { playbackTimeS } from "../client/playback";
import { button } from "../panel/buttons";
import type { Shown } from "../panel/dom_controls";
import { makeWidget } from "../panel/dom_widgets";
import { element } from "../panel/element";
import { timeSlider } from "../panel/walk";
import type { Widget } from "../panel/widgets";

/** The time shown moves on this often while it plays. */
const TICK_MS = 200;

export class Playbar {
  readonly root = element("div", "playbar");
  private readonly play: Shown;
  private readonly time: Shown;

  constructor(private readonly client: Client) {
    const [play, time] = this.widgets();
    const port = { dragOut: () => undefined };
    this.play = makeWidget(play, port);
    this.time = makeWidget(time, port);
    this.root.append(this.play.root, this.time.root);
    for (const slice of ["playback", "path", "session"] as const) client.store.subscribe(slice, () => this.update());
    setInterval(() => client.store.state.playback.playing && this.update(), TICK_MS);
  }

  private update(): void {
    const [play, time] = this.widgets();
    this.play.update(play);
    this.time.update(time);
    this.root.hidden = this.client.store.state.path.count === 0;
  }

  private widgets(): [Widget, Widget] {
    const { state } = this.client.store;
    const { actions } = this.client;
    const { playing } = state.playback;
    const disabled = state.session.role !== "editor";
    const run = (): void => void (playing ? actions.pause() : actions.play());
    const icon = playing ? "pause" : "play";
    const play = button("playbar-play", playing ? "Pause" : "Play", run, {
      icon,
      compact: true,
      tone: "primary",
      disabled,
    });
    const now = playbackTimeS(state.playback, Date.now());
    return [play, { ...timeSlider(state, actions, now, disabled), id: "playbar-time" }];
  }
}
