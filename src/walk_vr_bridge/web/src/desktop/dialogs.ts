// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What stands before the view: loading, failure, the pairing code, and the help. */

import { pair, renewCode } from "../client/admission";
import type { Client } from "../client/client";
import { element, setText } from "../panel/element";
import { KEYS } from "./keys";

/** Says that the building is loading, or why it cannot be shown. */
export function curtain(client: Client): HTMLElement {
  const root = element("div", "curtain");
  const card = element("div", "card");
  const title = element("h1");
  const text = element("p");
  const again = element("button", "button primary", "Try again");
  again.type = "button";
  again.addEventListener("click", () => client.retry());
  card.append(element("div", "spinner"), title, text, again);
  root.append(card);
  root.setAttribute("role", "status");
  const update = (): void => {
    const { loading, building, connection } = client.store.state;
    const failed = loading.failed || connection.phase === "refused";
    root.hidden = (building !== null && !failed) || connection.phase === "pairing";
    root.classList.toggle("failed", failed);
    again.hidden = connection.phase !== "refused";
    setText(title, failed ? "This does not work" : "Opening the building");
    const waiting = connection.phase === "connected" ? loading.building : connection.message;
    setText(text, loading.failed ? loading.building : waiting);
  };
  for (const slice of ["loading", "building", "connection"] as const) client.store.subscribe(slice, update);
  update();
  return root;
}

/** The form for the code that the bridge has printed; shows itself when one is asked for. */
export function pairing(client: Client): HTMLDialogElement {
  const dialog = element("dialog", "card pairing");
  const form = element("form");
  const input = element("input");
  Object.assign(input, {
    inputMode: "numeric",
    autocomplete: "one-time-code",
    maxLength: 9,
    required: true,
    id: "code",
  });
  const label = element("label", "", "Code from the bridge's window (8 digits)");
  label.htmlFor = input.id;
  const problem = element("p", "problem");
  problem.setAttribute("role", "alert");
  const enter = element("button", "button primary", "Connect");
  const renew = element("button", "button", "Print another code");
  renew.type = "button";
  const buttons = element("div", "row");
  buttons.append(enter, renew);
  form.append(element("h1", "", "Connect to the building"), label, input, problem, buttons);
  dialog.append(form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void pair(input.value.replace(/\D/g, "")).then((refused) => {
      problem.textContent = refused;
      if (!refused) void client.start();
    });
  });
  renew.addEventListener("click", () => {
    void renewCode().then(
      (refused) => (problem.textContent = refused || "Another code stands in the bridge's window."),
    );
  });
  dialog.addEventListener("cancel", (event) => event.preventDefault());
  client.store.subscribe("connection", () => {
    const wanted = client.store.state.connection.phase === "pairing";
    if (wanted && !dialog.open) dialog.showModal();
    else if (!wanted && dialog.open) dialog.close();
  });
  return dialog;
}

export function help(): HTMLDialogElement {
  const dialog = element("dialog", "card help");
  const close = element("button", "button", "Close");
  close.type = "button";
  close.addEventListener("click", () => dialog.close());
  const mouse = element(
    "p",
    "",
    "Drag a keypoint over its floor to move it; the walk follows. Drag beside one to turn the view, with Shift or the right button to move it; the wheel goes nearer. In the plan, dragging moves the plan.",
  );
  const list = element("dl");
  for (const [keys, does] of KEYS) list.append(element("dt", "", keys), element("dd", "", does));
  dialog.append(element("h1", "", "How it works"), mouse, list, close);
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  return dialog;
}
