// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";

import { VIEWS } from "../../src/desktop/header";
import { TABS } from "../../src/panel/widgets";

test("no two things to choose on the page have the same name", () => {
  const names = [...VIEWS, ...TABS].map(({ label }) => label);
  expect(new Set(names).size).toBe(names.length);
});
