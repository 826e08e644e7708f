// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** How much of the view the page's own parts cover at its edges [px]; what is shown is fitted to what they leave. */
export interface Covered {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
}

/** Measures it. A panel as wide as the window is a sheet at its foot. */
export function coveredBy(parts: { head: Element; rail: Element; panel: Element; playbar: Element }): Covered {
  const [head, rail, panel, playbar] = [parts.head, parts.rail, parts.panel, parts.playbar].map((part) =>
    part.getBoundingClientRect(),
  );
  const sheet = panel!.width > window.innerWidth * 0.8;
  const foot = sheet ? panel!.top : playbar!.height > 0 ? playbar!.top : window.innerHeight;
  return {
    left: sheet ? 0 : rail!.right,
    right: sheet ? 0 : window.innerWidth - panel!.left,
    top: head!.bottom,
    bottom: window.innerHeight - foot,
  };
}
