// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** A button with its edges: what is pressed now, and what has changed since the last frame. */
export class Button {
  down = false;
  pressed = false;
  released = false;

  /** Takes the state of this frame; analogue values get some play, so that a resting finger does not flutter. */
  update(value: number, least = 0.6, most = 0.35): void {
    const down = this.down ? value > most : value > least;
    this.pressed = down && !this.down;
    this.released = !down && this.down;
    this.down = down;
  }
}

/** A stick pushed one way, with its edges. */
export class Flick {
  pressed = false;
  released = false;
  down = false;

  update(value: number): void {
    const down = this.down ? value > 0.4 : value > 0.75;
    this.pressed = down && !this.down;
    this.released = !down && this.down;
    this.down = down;
  }
}
