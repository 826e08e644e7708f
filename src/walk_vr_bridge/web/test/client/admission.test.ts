// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { afterEach, describe, expect, it, vi } from "vitest";
import { pair } from "../../src/client/admission";

afterEach(() => vi.unstubAllGlobals());

function answering(status: number, body: unknown): void {
  vi.stubGlobal("fetch", () => Promise.resolve(new Response(JSON.stringify(body), { status })));
}

describe("a refused code", () => {
  it("is told in sentences, with the tries that are left", async () => {
    answering(403, { error: "this is not the code", tries_left: 4 });
    expect(await pair("12345678")).toBe("This is not the code. Tries left: 4.");
  });

  it("is told where the bridge gives no reason, or does not answer", async () => {
    answering(500, null);
    expect(await pair("1")).toBe("The bridge refused (500).");
    vi.stubGlobal("fetch", () => Promise.reject(new Error("no network")));
    expect(await pair("1")).toBe("The bridge does not answer.");
    answering(200, { role: "editor" });
    expect(await pair("1")).toBe("");
  });
});
