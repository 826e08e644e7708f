// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Getting in: the token of the address, a code typed by hand, and the secret that names this client. */

import { fields, words } from "./check";

export interface Admission {
  readonly role: "viewer" | "editor" | null;
  readonly namespace: string;
}

const SECRET_KEY = "walk.client";
const SECRET_BYTES = 24;

/** Returns this tab's own name for the server, the same after a reload, so that what it held is still its own. */
export function clientSecret(storage: Storage): string {
  const known = storage.getItem(SECRET_KEY);
  if (known && /^[\w-]{16,64}$/.test(known)) return known;
  const bytes = crypto.getRandomValues(new Uint8Array(SECRET_BYTES));
  const secret = Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
  storage.setItem(SECRET_KEY, secret);
  return secret;
}

export function socketUrl(location: Location, secret: string): string {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  return `${scheme}://${location.host}/ws?client=${secret}`;
}

/** Logs in with the address's token, if it has one, and takes it out of the address. Returns a refusal's sentence. */
export async function useAddressToken(location: Location, history: History): Promise<string> {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  if (!token) return "";
  history.replaceState(null, "", location.pathname + location.search);
  return post("/api/login", { token });
}

/** Returns what the server takes this client for. @throws MessageError, TypeError where there is no server. */
export async function askAdmission(): Promise<Admission> {
  const answer = await fetch("/api/session", { cache: "no-store" });
  const said = fields(await answer.json(), "session");
  const role = said.role === "viewer" || said.role === "editor" ? said.role : null;
  return { role, namespace: words(said.namespace, "namespace") };
}

/** Tries a pairing code; returns a refusal's sentence, "" where it let the client in. */
export function pair(code: string): Promise<string> {
  return post("/api/pair", { code });
}

/** Asks the bridge to print another code. */
export function renewCode(): Promise<string> {
  return post("/api/pair", { renew: true });
}

async function post(url: string, body: unknown): Promise<string> {
  const headers = { "Content-Type": "application/json" };
  const answer = await fetch(url, { method: "POST", headers, body: JSON.stringify(body) }).catch(() => null);
  if (!answer) return "The bridge does not answer.";
  if (answer.ok) return "";
  const said = (await answer.json().catch(() => null)) as { error?: unknown; tries_left?: unknown } | null;
  const reason = typeof said?.error === "string" ? sentence(said.error) : `The bridge refused (${answer.status}).`;
  return typeof said?.tries_left === "number" ? `${reason} Tries left: ${said.tries_left}.` : reason;
}

/** A reason as the bridge gives it, as a sentence of its own. */
function sentence(reason: string): string {
  return reason.charAt(0).toUpperCase() + reason.slice(1).replace(/[.]?$/, ".");
}
