// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/**
 * Messages from the socket's worker in memory that both threads see: the page empties it at the begin of a frame, where a
 * message that was posted would wait until the frame has been drawn. One writes, one reads.
 */

export type Letter = string | ArrayBuffer;

const CAPACITY = 2 ** 20;
/** A longer letter goes in parts, so that any length fits. */
const MOST_IN_A_PART = CAPACITY / 4;
const HEAD = 8;
/** Where in the control words: up to where it is written, and read; what is between waits. */
const [WRITTEN, READ] = [0, 1];
const [TEXT, MORE] = [1, 2];

export class Postbox {
  private readonly control: Int32Array;
  private readonly words: Int32Array;
  private readonly bytes: Uint8Array;
  private readonly capacity: number;
  private parts: Uint8Array[] = [];
  /** Of the letter that is being put: what of it is still to come. */
  private rest: Uint8Array | null = null;

  constructor(readonly shared: SharedArrayBuffer) {
    this.capacity = shared.byteLength - HEAD;
    this.control = new Int32Array(shared, 0, 2);
    this.words = new Int32Array(shared, HEAD);
    this.bytes = new Uint8Array(shared, HEAD);
  }

  /** Returns an empty one; null where the browser shares no memory: without the headers that isolate a page, or an old one. */
  static make(capacity = CAPACITY): Postbox | null {
    const able = typeof SharedArrayBuffer !== "undefined" && globalThis.crossOriginIsolated !== false;
    return able ? new Postbox(new SharedArrayBuffer(HEAD + capacity)) : null;
  }

  /** Puts a letter in; false where there is no room for all of it yet: then the same letter has to be put again. */
  put(letter: Letter): boolean {
    this.rest ??= typeof letter === "string" ? new TextEncoder().encode(letter) : new Uint8Array(letter);
    const kind = typeof letter === "string" ? TEXT : 0;
    const most = Math.min(MOST_IN_A_PART, this.capacity / 4);
    while (this.rest.length > most) {
      if (!this.write(this.rest.subarray(0, most), kind | MORE)) return false;
      this.rest = this.rest.subarray(most);
    }
    if (!this.write(this.rest, kind)) return false;
    this.rest = null;
    return true;
  }

  /** Returns the next letter that is in it as a whole; null where there is none. */
  take(): Letter | null {
    for (;;) {
      const at = Atomics.load(this.control, READ);
      if (at === Atomics.load(this.control, WRITTEN)) return null;
      const [length, kind] = [this.words[at / 4]!, this.words[at / 4 + 1]!];
      this.parts.push(this.copyOut((at + HEAD) % this.capacity, length));
      Atomics.store(this.control, READ, (at + HEAD + padded(length)) % this.capacity);
      if (kind & MORE) continue;
      const whole = this.parts.length === 1 ? this.parts[0]! : joined(this.parts);
      this.parts = [];
      return kind & TEXT ? new TextDecoder().decode(whole) : (whole.buffer as ArrayBuffer);
    }
  }

  private write(part: Uint8Array, kind: number): boolean {
    const at = Atomics.load(this.control, WRITTEN);
    const free = (Atomics.load(this.control, READ) - at - HEAD + this.capacity) % this.capacity;
    if (HEAD + padded(part.length) > free) return false;
    this.words[at / 4] = part.length;
    this.words[at / 4 + 1] = kind;
    const begin = (at + HEAD) % this.capacity;
    const first = Math.min(part.length, this.capacity - begin);
    this.bytes.set(part.subarray(0, first), begin);
    this.bytes.set(part.subarray(first), 0);
    Atomics.store(this.control, WRITTEN, (at + HEAD + padded(part.length)) % this.capacity);
    return true;
  }

  private copyOut(begin: number, length: number): Uint8Array {
    const copy = new Uint8Array(length);
    const first = Math.min(length, this.capacity - begin);
    copy.set(this.bytes.subarray(begin, begin + first));
    copy.set(this.bytes.subarray(0, length - first), first);
    return copy;
  }
}

function padded(length: number): number {
  return Math.ceil(length / HEAD) * HEAD;
}

function joined(parts: readonly Uint8Array[]): Uint8Array {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
