// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Postbox, type Letter } from "../../src/client/postbox";

function pair(capacity: number): [Postbox, Postbox] {
  const writer = Postbox.make(capacity)!;
  return [writer, new Postbox(writer.shared)];
}

const plain = (letter: Letter | null): unknown => (letter instanceof ArrayBuffer ? Array.from(new Uint8Array(letter)) : letter);
const bytes = (length: number, from = 0): ArrayBuffer => Uint8Array.from({ length }, (_, i) => (from + i) % 256).buffer;

describe("a postbox", () => {
  it("gives back texts and bytes in their order, also empty ones and around its end", () => {
    const [writer, reader] = pair(256);
    for (let round = 0; round < 200; round++) {
      const letters: Letter[] = ["", `größer ${round}`, bytes(round % 40, round), bytes(0)];
      for (const letter of letters) expect(writer.put(letter)).toBe(true);
      expect(letters.map(() => plain(reader.take()))).toEqual(letters.map(plain));
      expect(reader.take()).toBeNull();
    }
  });

  it("takes no more than there is room for, and the same letter later", () => {
    const [writer, reader] = pair(128);
    let put = 0;
    while (writer.put(bytes(24, put))) put += 1;
    expect(put).toBe(3);
    for (let at = 0; at < 3; at++) expect(plain(reader.take())).toEqual(plain(bytes(24, at)));
    expect(writer.put(bytes(24, put))).toBe(true);
    expect(plain(reader.take())).toEqual(plain(bytes(24, put)));
  });

  it("passes a letter that is longer than itself in parts", () => {
    const [writer, reader] = pair(128);
    const long = bytes(1000);
    let letter: Letter | null = null;
    for (let done = false; !done; ) {
      done = writer.put(long);
      const taken = reader.take();
      letter ??= taken;
      if (!done) expect(taken).toBeNull();
    }
    expect(plain(letter)).toEqual(plain(long));
    expect(writer.put("next")).toBe(true);
    expect(reader.take()).toBe("next");
  });
});
