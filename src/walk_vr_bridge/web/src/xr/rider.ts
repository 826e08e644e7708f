// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Vector3 } from "three";
import type { Actions } from "../client/actions";
import { playbackTimeS } from "../client/playback";
import type { Store } from "../client/store";
import { headingOf } from "../scene/axes";
import type { Stage } from "../scene/stage";
import { type Comfort, vignetteFor } from "./comfort";
import type { Inputs } from "./input";
import { Ride, type Stand } from "./ride";
import type { Rig } from "./rig";
import type { Travel } from "./travel";

/** Binds the ride to playback, rig and hands. */
export class Rider {
  readonly ride = new Ride();
  private readonly now: Stand = { x: 0, y: 0, z: 0, heading: 0 };
  private readonly goal: Stand = { x: 0, y: 0, z: 0, heading: 0 };
  private readonly old: Stand = { x: 0, y: 0, z: 0, heading: 0 };
  private wasPlaying = false;

  constructor(
    private readonly stage: Stage,
    private readonly store: Store,
    private readonly actions: Actions,
    private readonly rig: Rig,
    private readonly travel: Travel,
    private readonly comfort: Comfort,
  ) {}

  /** Whether the tour moves the user at the moment: then buttons mean stop, nothing else. */
  get carries(): boolean {
    const { phase } = this.ride;
    return phase === "back" || (phase === "on" && this.store.state.playback.playing);
  }

  /** Play or pause, as the button and the panel mean it. */
  toggle(): void {
    if (this.ride.phase === "strayed") this.ride.leadBack();
    else if (this.store.state.playback.playing) void this.actions.pause();
    else void this.actions.play();
  }

  /** Leaves the ride for good. */
  stop(): void {
    this.ride.end();
    this.stage.riding = false;
  }

  /** @param carried whether the tour moved the user when this frame began: the press that starts it does not stop it. */
  update(inputs: Inputs, carried: boolean, seconds: number): void {
    const { playback, settings } = this.store.state;
    const { ride } = this;
    const started = playback.playing && !this.wasPlaying;
    this.wasPlaying = playback.playing;
    if (settings.playbackPlace !== "ride") {
      if (ride.phase !== "off") this.stop();
      this.comfort.narrow(settings.vignette ? vignetteFor(this.travel.speed, 0) : 0);
      return;
    }
    if (ride.phase === "off" && playback.playing) this.begin();
    if (ride.phase === "strayed" && started) {
      // Play was pressed on the panel: first back to the tour, then on.
      void this.actions.pause();
      ride.leadBack();
    }
    this.listenToHands(inputs, carried);
    this.stage.riding = ride.phase === "on";
    if (ride.phase === "on") this.follow(seconds);
    else if (ride.phase === "strayed") this.wander();
    else if (ride.phase === "back") this.goBack(seconds);
    const speed = ride.phase === "strayed" ? this.travel.speed : ride.speed;
    this.comfort.narrow(settings.vignette ? vignetteFor(speed, ride.turnRate) : 0);
  }

  /** From nowhere: the first step onto the tour is a leap. */
  private begin(): void {
    this.now.x = Infinity;
    this.ride.begin();
  }

  /** Any button stops what carries the user; walking or jumping off is straying. */
  private listenToHands(inputs: Inputs, carried: boolean): void {
    const { ride, travel } = this;
    if (ride.phase === "off") return;
    const walks = travel.speed > 0 || travel.jumped;
    if (carried && (inputs.anyPressed || walks)) {
      if (ride.phase === "on") void this.actions.pause();
      this.stray();
    } else if (ride.phase === "on" && walks) this.stray();
  }

  private stray(): void {
    this.ride.stray(playbackTimeS(this.store.state.playback, Date.now()), this.now);
  }

  private follow(seconds: number): void {
    if (!this.aim()) return;
    Object.assign(this.old, this.now);
    this.ride.follow(this.now, this.goal, seconds);
    this.moveRig();
  }

  private wander(): void {
    const { eye } = this.stage.view;
    this.now.x = eye.x;
    this.now.y = -eye.z;
    this.now.z = this.rig.group.position.y;
    this.ride.wander(this.now.x, this.now.y, this.now.z);
  }

  private goBack(seconds: number): void {
    Object.assign(this.old, this.now);
    const there = this.ride.walkBack(this.now, seconds);
    this.moveRig();
    if (!there) return;
    this.actions.seek(this.ride.leftAtS);
    void this.actions.play();
  }

  /** Where the tour stands now; false where there is none. */
  private aim(): boolean {
    const { player } = this.stage;
    if (this.store.state.path.count === 0) return false;
    this.goal.x = player.position[0];
    this.goal.y = player.position[1];
    this.goal.z = player.position[2] - this.stage.eyeHeightM;
    this.goal.heading = headingOf(player.quat[0], player.quat[1], player.quat[2], player.quat[3]);
    return true;
  }

  /** The rig does the step that `now` has done; a leap brings the head itself onto the tour, looking along it. */
  private moveRig(): void {
    const { now, old, rig } = this;
    if (!this.ride.leapt) {
      rig.turn(now.heading - old.heading);
      rig.move(now.x - old.x, now.z - old.z, -(now.y - old.y));
      return;
    }
    if (this.store.state.settings.fade) this.comfort.blink();
    this.stage.view.camera.getWorldDirection(AHEAD);
    if (this.ride.phase === "on") rig.turn(now.heading - Math.atan2(-AHEAD.z, AHEAD.x));
    rig.headTo(now.x, now.z, -now.y);
  }
}

const AHEAD = new Vector3();
