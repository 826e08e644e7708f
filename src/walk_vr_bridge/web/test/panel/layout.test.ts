// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { layOut, lines } from "../../src/panel/layout";
import { HEIGHT, SIZE, slideAt, TABS_HEIGHT, WIDTH, zoneAt, type Layout, type Measure } from "../../src/panel/sheet";
import type { TabId } from "../../src/panel/widgets";
import { setUp } from "./fixtures";

/** A face in which each letter is as wide as in a wide one. */
const measure: Measure = (text, size) => text.length * size * 0.58;

function layoutOf(
  tab: TabId,
  prepare: (world: ReturnType<typeof setUp>) => void = () => undefined,
): Layout & ReturnType<typeof setUp> {
  const world = setUp();
  prepare(world);
  world.model.open(tab);
  return { ...world, ...layOut(tab, (next) => world.model.open(next), world.model.sections(), measure) };
}

const TABS: TabId[] = ["tour", "view", "tune", "walk", "study"];

describe.each(TABS)("the picture of the tab %s", (tab) => {
  const layout = layoutOf(tab, ({ store }) => store.patch("selection", { keypoint: 7 }));

  it("keeps everything on the sheet and nothing over anything else", () => {
    for (const zone of layout.zones) {
      expect(zone.x).toBeGreaterThanOrEqual(0);
      expect(zone.x + zone.w).toBeLessThanOrEqual(WIDTH);
    }
    const usable = layout.zones.filter(({ press, slide }) => press || slide);
    for (const [index, a] of usable.entries()) {
      for (const b of usable.slice(index + 1)) {
        const apart =
          a.x + a.w <= b.x + 0.01 || b.x + b.w <= a.x + 0.01 || a.y + a.h <= b.y + 0.01 || b.y + b.h <= a.y + 0.01;
        expect(apart, `${a.key} and ${b.key}`).toBe(true);
      }
    }
  });

  it("can be hit and read: nothing to press is lower than 64 px, no text smaller than 24 px or cut off", () => {
    for (const zone of layout.zones) {
      if (zone.press) expect(zone.h, zone.key).toBeGreaterThanOrEqual(64);
      const wide = zone.look === "item" ? zone.w - 110 : zone.w;
      for (const line of zone.lines)
        expect(measure(line, SIZE.small), `${zone.key}: ${line}`).toBeLessThanOrEqual(wide + 1);
    }
    expect(Math.min(...Object.values(SIZE))).toBeGreaterThanOrEqual(24);
  });

  it("has each zone where it is hit", () => {
    for (const zone of layout.zones) {
      if (!zone.press || zone.disabled) continue;
      const scroll = zone.look === "tab" ? 0 : Math.max(0, zone.y - HEIGHT / 2);
      const y = zone.y + zone.h / 2 - (zone.look === "tab" ? 0 : scroll);
      expect(zoneAt(layout, zone.x + zone.w / 2, y, scroll)?.key).toBe(zone.key);
    }
  });

  it("names no two zones alike", () => {
    const keys = layout.zones.map(({ key }) => key);
    expect(new Set(keys).size).toBe(keys.length);
  });
});

describe("hits", () => {
  it("on a tab open it, whatever is scrolled under it", () => {
    const { zones, model, bottom } = layoutOf("tour");
    zoneAt({ zones, bottom }, WIDTH * 0.3, TABS_HEIGHT / 2, 300)!.press!();
    expect(model.tab).toBe("view");
  });

  it("on a slider are its position, up to both ends", () => {
    const layout = layoutOf("tune");
    const zone = layout.zones.find(({ key }) => key.endsWith("trajopt.clearance_m"))!;
    expect([slideAt(zone, 0), slideAt(zone, zone.x + zone.w / 2), slideAt(zone, WIDTH)]).toEqual([0, 0.5, 1]);
    zone.slide!(0.5, true);
    // An even travel from 0 to four times the value.
    expect(layout.asked.at(-1)![2]).toBe(0.84);
  });

  it("miss what is disabled", () => {
    const layout = layoutOf("walk");
    const play = layout.zones.find(({ key }) => key.endsWith(":play"))!;
    expect(play.disabled).toBe(true);
    expect(zoneAt(layout, play.x + 5, play.y + 5, 0)).toBeNull();
  });
});

describe("titles", () => {
  it("fit, though bold letters are wider than they are measured", () => {
    const text = "I think that I would like to use this system frequently.";
    const widget = { kind: "note", id: "title", text, tone: "title" } as const;
    const { zones } = layOut("study", () => undefined, [{ id: "one", title: "", widgets: [widget] }], measure);
    const zone = zones.find(({ key }) => key === "one/title")!;
    expect(zone.lines.join(" ")).toBe(text);
    for (const line of zone.lines) expect(1.12 * measure(line, SIZE.title)).toBeLessThanOrEqual(zone.w);
  });
});

describe("lines", () => {
  it("hold all words in their order and fit where a word does", () => {
    const text = "Move the keypoints so that the tour shows a visitor every room of the storey you are on.";
    const broken = lines(text, 32, 400, measure);
    expect(broken.join(" ")).toBe(text);
    for (const line of broken) expect(measure(line, 32)).toBeLessThanOrEqual(400);
    expect(lines("unbreakable-word-that-is-long", 32, 100, measure)).toHaveLength(1);
  });
});
