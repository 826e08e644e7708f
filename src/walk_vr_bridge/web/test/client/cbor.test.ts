// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { decodeCbor } from "../../src/client/cbor";

const bytes = (hex: string): ArrayBuffer => {
  const found = hex.match(/../g) ?? [];
  return new Uint8Array(found.map((pair) => Number.parseInt(pair, 16))).buffer;
};

describe("CBOR", () => {
  // The examples of RFC 8949, appendix A.
  it.each([
    ["00", 0],
    ["1818", 24],
    ["1903e8", 1000],
    ["1a000f4240", 1000000],
    ["1b000000e8d4a51000", 1000000000000],
    ["20", -1],
    ["3903e7", -1000],
    ["f93c00", 1],
    ["f90001", 5.960464477539063e-8],
    ["fa47c35000", 100000],
    ["fb3ff199999999999a", 1.1],
    ["f97c00", Infinity],
    ["f4", false],
    ["f5", true],
    ["f6", null],
    ["62c3bc", "\u00fc"],
    ["83010203", [1, 2, 3]],
    ["8301820203820405", [1, [2, 3], [4, 5]]],
    ["a26161016162820203", { a: 1, b: [2, 3] }],
  ])("reads %s", (hex, value) => {
    expect(decodeCbor(bytes(hex))).toEqual(value);
  });

  it("reads typed arrays of RFC 8746, wherever they lie", () => {
    const doubles = new Float64Array([1.5, -2.25]);
    const body = Array.from(new Uint8Array(doubles.buffer));
    const message = new Uint8Array([0xa1, 0x61, 0x78, 0xd8, 86, 0x50, ...body]).buffer;
    expect(decodeCbor(message)).toEqual({ x: doubles });
  });

  it.each(["", "ff", "62c3", "9bffffffffffffffff", "a1016161", "0000", "5f", "1c", "81".repeat(40) + "00"])(
    "refuses %s",
    (hex) => {
      expect(() => decodeCbor(bytes(hex))).toThrow();
    },
  );

  it("cannot be made to change what all objects have", () => {
    const polluted = decodeCbor(bytes("a1695f5f70726f746f5f5fa1616101")) as Record<string, unknown>;
    expect(({} as Record<string, unknown>).a).toBeUndefined();
    expect(Object.getPrototypeOf(polluted)).toBeNull();
  });
});
