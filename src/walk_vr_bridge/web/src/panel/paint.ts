// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Draws the panel's zones on a canvas. */

import { HEIGHT, SIZE, SLIDER_INSET, TABS_HEIGHT, WIDTH, type Layout, type Zone } from "./sheet";
import { centred, drawIcon, font, round, write } from "./strokes";

const C = {
  ink: "#1e2731",
  soft: "#4c5864",
  line: "#ccd4db",
  paper: "#ffffff",
  wash: "#f0f3f5",
  accent: "#1668c7",
  accentWash: "#e0edfb",
  hover: "#dfe8f0",
  bad: "#a51d25",
  good: "#14743f",
  wait: "#7a5200",
  pin: "#ffb02e",
  off: "#b4bfc8",
} as const;
const NUMBERS: Readonly<Record<string, readonly [string, string]>> = {
  plain: [C.pin, "#332200"],
  start: ["#2fbf71", "#06301a"],
  end: ["#e5484d", "#ffffff"],
  warn: ["#8b2635", "#ffffff"],
};
const SCALE = ["#2b1c61", "#294d94", "#1a8094", "#33ad70", "#9ed140", "#fce840"];

export interface Marks {
  /** Keys of the zones that rays are at. */
  readonly hovered: ReadonlySet<string>;
  readonly pressed: ReadonlySet<string>;
  /** Where a slider that is being moved has its knob. */
  readonly sliding: ReadonlyMap<string, number>;
}

/** Draws all of it; what is scrolled away is clipped. */
export function paint(pen: CanvasRenderingContext2D, layout: Layout, scroll: number, marks: Marks): void {
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.clearRect(0, 0, WIDTH, HEIGHT);
  round(pen, 0, 0, WIDTH, HEIGHT, 36, C.paper);
  pen.save();
  pen.beginPath();
  pen.rect(0, TABS_HEIGHT, WIDTH, HEIGHT - TABS_HEIGHT - 8);
  pen.clip();
  pen.translate(0, -scroll);
  for (const zone of layout.zones) {
    const seen = zone.y + zone.h > scroll + TABS_HEIGHT && zone.y < scroll + HEIGHT;
    if (zone.look !== "tab" && seen) draw(pen, zone, marks);
  }
  pen.restore();
  for (const zone of layout.zones) if (zone.look === "tab") tab(pen, zone, marks.hovered.has(zone.key));
  pen.fillStyle = C.line;
  pen.fillRect(0, TABS_HEIGHT - 2, WIDTH, 2);
  scrollbar(pen, layout.bottom, scroll);
}

function scrollbar(pen: CanvasRenderingContext2D, bottom: number, scroll: number): void {
  const seen = HEIGHT - TABS_HEIGHT;
  const all = bottom - TABS_HEIGHT;
  if (all <= seen) return;
  const height = Math.max(60, (seen * seen) / all);
  const top = TABS_HEIGHT + 8 + ((seen - height - 24) * scroll) / (all - seen);
  round(pen, WIDTH - 16, top, 8, height, 4, C.off);
}

function draw(pen: CanvasRenderingContext2D, zone: Zone, marks: Marks): void {
  const hovered = marks.hovered.has(zone.key);
  const pressed = marks.pressed.has(zone.key);
  pen.globalAlpha = zone.disabled ? 0.45 : 1;
  if (zone.look === "heading") write(pen, zone.lines, zone.x, zone.y, SIZE.small, C.soft, 600);
  else if (zone.look === "text") note(pen, zone);
  else if (zone.look === "button") button(pen, zone, hovered, pressed);
  else if (zone.look === "segment") segment(pen, zone, hovered);
  else if (zone.look === "toggle") toggle(pen, zone, hovered);
  else if (zone.look === "slider") slider(pen, zone, hovered, marks.sliding.get(zone.key));
  else if (zone.look === "item") item(pen, zone, hovered);
  else if (zone.look === "drag") drag(pen, zone, hovered);
  else if (zone.look === "legend") legend(pen, zone);
  else if (zone.look === "mark") mark(pen, zone, hovered);
  else if (zone.look === "value") centred(pen, zone.lines[0] ?? "", zone, C.ink);
  pen.globalAlpha = 1;
}

function tab(pen: CanvasRenderingContext2D, zone: Zone, hovered: boolean): void {
  const colour = zone.on ? C.accent : C.soft;
  if (hovered && !zone.on) round(pen, zone.x + 8, 8, zone.w - 16, zone.h - 20, 18, C.wash);
  if (zone.icon) drawIcon(pen, zone.icon, zone.x + zone.w / 2 - 22, 18, 44, colour);
  pen.font = font(SIZE.small, zone.on ? 600 : 400);
  pen.fillStyle = colour;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(zone.lines[0] ?? "", zone.x + zone.w / 2, 92);
  if (zone.on) pen.fillRect(zone.x + 30, TABS_HEIGHT - 6, zone.w - 60, 6);
}

function note(pen: CanvasRenderingContext2D, zone: Zone): void {
  const colour = { warn: C.bad, wait: C.wait, good: C.good, title: C.ink }[zone.tone ?? ""] ?? C.soft;
  const title = zone.tone === "title";
  write(pen, zone.lines, zone.x, zone.y, title ? SIZE.title : SIZE.body, colour, title ? 600 : 400);
}

function button(pen: CanvasRenderingContext2D, zone: Zone, hovered: boolean, pressed: boolean): void {
  const primary = zone.tone === "primary";
  const fill = primary ? C.accent : pressed ? C.hover : zone.on ? C.accentWash : hovered ? C.wash : C.paper;
  const ink = primary ? "#ffffff" : zone.tone === "danger" ? C.bad : zone.on ? C.accent : C.ink;
  round(pen, zone.x + 1.5, zone.y + 1.5, zone.w - 3, zone.h - 3, 18, fill, hovered || zone.on ? C.accent : C.line);
  if (primary && hovered) round(pen, zone.x, zone.y, zone.w, zone.h, 18, "rgba(0, 0, 0, 0.14)");
  const label = zone.lines[0];
  if (!zone.icon) return centred(pen, label ?? "", zone, ink);
  const middle = zone.y + zone.h / 2;
  if (!label) return drawIcon(pen, zone.icon, zone.x + zone.w / 2 - 21, middle - 21, 42, ink);
  pen.font = font(SIZE.body, 500);
  const left = zone.x + (zone.w - pen.measureText(label).width - 52) / 2;
  drawIcon(pen, zone.icon, left, middle - 20, 40, ink);
  pen.fillStyle = ink;
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  pen.fillText(label, left + 52, middle + 1);
}

function segment(pen: CanvasRenderingContext2D, zone: Zone, hovered: boolean): void {
  round(pen, zone.x, zone.y, zone.w, zone.h, 16, zone.on ? C.accent : hovered ? C.hover : C.wash);
  centred(pen, zone.lines[0] ?? "", zone, zone.on ? "#ffffff" : C.ink, zone.on ? 600 : 400);
}

function toggle(pen: CanvasRenderingContext2D, zone: Zone, hovered: boolean): void {
  if (hovered) round(pen, zone.x - 14, zone.y, zone.w + 28, zone.h, 18, C.wash);
  write(pen, zone.lines, zone.x, zone.y + (zone.detail ? 10 : 22), SIZE.body, C.ink, 500);
  if (zone.detail) write(pen, [zone.detail], zone.x, zone.y + 52, SIZE.small, C.soft);
  const [x, y] = [zone.x + zone.w - 92, zone.y + zone.h / 2 - 26];
  round(pen, x, y, 92, 52, 26, zone.on ? C.accent : C.off);
  round(pen, x + (zone.on ? 46 : 6), y + 6, 40, 40, 20, "#ffffff");
}

function slider(pen: CanvasRenderingContext2D, zone: Zone, hovered: boolean, sliding: number | undefined): void {
  const position = sliding ?? zone.position ?? 0;
  write(pen, zone.lines, zone.x, zone.y, SIZE.body, C.ink);
  pen.font = font(SIZE.body, 600);
  pen.fillStyle = C.accent;
  pen.textAlign = "right";
  pen.fillText(zone.text?.(position) ?? "", zone.x + zone.w, zone.y);
  const [left, span, y] = [zone.x + SLIDER_INSET, zone.w - 2 * SLIDER_INSET, zone.y + 72];
  round(pen, left, y - 5, span, 10, 5, C.line);
  round(pen, left, y - 5, span * position, 10, 5, C.accent);
  const radius = hovered || sliding !== undefined ? 24 : 20;
  round(pen, left + span * position - radius, y - radius, 2 * radius, 2 * radius, radius, "#ffffff", C.accent);
}

function item(pen: CanvasRenderingContext2D, zone: Zone, hovered: boolean): void {
  if (zone.on) round(pen, zone.x, zone.y, zone.w, zone.h, 18, C.accentWash, C.accent);
  else if (hovered) round(pen, zone.x, zone.y, zone.w, zone.h, 18, C.wash);
  const [fill, ink] = NUMBERS[zone.tone ?? "plain"] ?? NUMBERS.plain!;
  round(pen, zone.x + 16, zone.y + zone.h / 2 - 27, 54, 54, 27, fill);
  pen.font = font(SIZE.small, 600);
  pen.fillStyle = ink;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(zone.number ?? "", zone.x + 43, zone.y + zone.h / 2 + 1);
  write(pen, zone.lines, zone.x + 92, zone.y + (zone.detail ? 8 : 24), SIZE.body, C.ink, 500);
  if (zone.detail)
    write(pen, [zone.detail], zone.x + 92, zone.y + 47, SIZE.small, zone.tone === "warn" ? C.bad : C.soft);
}

function drag(pen: CanvasRenderingContext2D, zone: Zone, hovered: boolean): void {
  pen.setLineDash([14, 10]);
  round(
    pen,
    zone.x + 2,
    zone.y + 2,
    zone.w - 4,
    zone.h - 4,
    18,
    hovered ? C.accentWash : C.wash,
    hovered ? C.accent : C.off,
  );
  pen.setLineDash([]);
  round(pen, zone.x + 24, zone.y + zone.h / 2 - 24, 48, 48, 24, C.pin, "#ffffff");
  write(pen, zone.lines, zone.x + 96, zone.y + 14, SIZE.body, C.ink, 500);
  write(pen, [zone.detail ?? ""], zone.x + 96, zone.y + 58, SIZE.small, C.soft);
}

function legend(pen: CanvasRenderingContext2D, zone: Zone): void {
  const bare = zone.tone === "bare";
  if (!bare) {
    const fill = pen.createLinearGradient(zone.x, 0, zone.x + zone.w, 0);
    SCALE.forEach((colour, index) => fill.addColorStop(index / (SCALE.length - 1), colour));
    pen.fillStyle = fill;
    pen.beginPath();
    pen.roundRect(zone.x, zone.y, zone.w, 22, 11);
    pen.fill();
  }
  const y = zone.y + (bare ? 0 : 34);
  write(pen, [zone.lines[0] ?? ""], zone.x, y, SIZE.small, C.soft);
  pen.textAlign = "right";
  pen.fillText(zone.lines[1] ?? "", zone.x + zone.w, y);
}

function mark(pen: CanvasRenderingContext2D, zone: Zone, hovered: boolean): void {
  const gap = zone.lines.length > 0 ? 6 : 1;
  const fill = zone.on ? C.accent : hovered ? C.hover : C.wash;
  round(
    pen,
    zone.x + gap,
    zone.y,
    zone.w - 2 * gap,
    zone.h,
    zone.lines.length > 0 ? 18 : 6,
    fill,
    zone.on ? C.accent : C.line,
  );
  if (zone.lines[0]) centred(pen, zone.lines[0], zone, zone.on ? "#ffffff" : C.ink);
}
