// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Line icons on a field of 24 by 24, as path data: the page strokes them as SVG, the headset's panel on a canvas. */

export const ICONS = {
  route: "M6 19a2 2 0 1 0 0-4 2 2 0 0 0 0 4ZM18 9a2 2 0 1 0 0-4 2 2 0 0 0 0 4ZM8 17h7a3 3 0 0 0 0-6H9a3 3 0 0 1 0-6h7",
  eye: "M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12ZM12 15a3 3 0 1 0 0-6 3 3 0 0 0 0 6Z",
  tune: "M4 7h9M17 7h3M4 17h3M11 17h9M15 9.5a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5ZM9 19.5a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5Z",
  play: "M7.5 5v14l11-7Z",
  pause: "M8 5v14M16 5v14",
  stop: "M6.5 6.5h11v11h-11Z",
  study: "M6 3.5h12v17H6ZM9 8h6M9 12h6M9 16h3",
  undo: "M8.5 5 4 9.5 8.5 14M4 9.5h10a6 6 0 0 1 0 10h-3",
  redo: "M15.5 5 20 9.5 15.5 14M20 9.5H10a6 6 0 0 0 0 10h3",
  lock: "M5.5 11h13v9h-13ZM8.5 11V8a3.5 3.5 0 0 1 7 0v3",
  unlock: "M5.5 11h13v9h-13ZM8.5 11V8a3.5 3.5 0 0 1 6.8-1.2",
  start: "M6 21V4M6 4h11l-2.5 4 2.5 4H6",
  end: "M6 21V4h12v8H6M10 4v8M14 4v8M6 8h12",
  trash: "M4.5 7h15M9 7V4.5h6V7M6.5 7l1 13h9l1-13M10 11v5M14 11v5",
  up: "M12 19V5M6 11l6-6 6 6",
  down: "M12 5v14M6 13l6 6 6-6",
  plus: "M12 5v14M5 12h14",
  minus: "M5 12h14",
  target: "M12 20a8 8 0 1 0 0-16 8 8 0 0 0 0 16ZM12 2v5M12 17v5M2 12h5M17 12h5",
  help: "M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18ZM9.5 9.5a2.5 2.5 0 1 1 3.5 2.3c-.7.3-1 .9-1 1.7M12 16.5v.5",
  close: "M6 6l12 12M18 6 6 18",
  headset: "M3 8.5h18v8h-6l-1.5-2h-3l-1.5 2H3ZM7 12h.01M17 12h.01",
  plan: "M4 4h16v16H4ZM4 11h7M11 4v4M11 11v2M11 16.5V20",
  cube: "M12 3 4 7.5v9L12 21l8-4.5v-9ZM4 7.5l8 4.5 8-4.5M12 12v9",
  walk: "M13 6.5a1.8 1.8 0 1 0 0-3.6 1.8 1.8 0 0 0 0 3.6ZM12 9l-3.5 2.5V15M12 9l1 5-3 7M12 9l2.5 3 3 1M13 14l3 2.5V21",
  download: "M12 4v11M7 10.5l5 5 5-5M5 20h14",
  check: "M5 12.5l4.5 4.5L19 7.5",
} as const;

export type IconName = keyof typeof ICONS;
