// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import type { Button } from "./widgets";

/** Returns a button; what it looks like beyond its label stands in `more`. */
export function button(
  id: string,
  label: string,
  run: () => void,
  more: Partial<Omit<Button, "kind" | "id" | "run">> = {},
): Button {
  return { kind: "button", id, label, run, ...more };
}
