// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Where everything of the panel is on the headset's picture: no drawing here, so it can be tested. */

import { PAD, SIZE, TABS_HEIGHT, WIDTH, type Layout, type Look, type Measure, type Zone } from "./sheet";
import { TABS, type Button, type Section, type TabId, type Widget } from "./widgets";

const LINE = 1.32;
const GAP = 16;
const ROW = 80;
const INNER = WIDTH - 2 * PAD;
const MARKS_LEAST = 24;
/** Letters of titles and headings are so much wider than they are measured. */
const BOLD = 1.14;

export function layOut(tab: TabId, open: (tab: TabId) => void, sections: readonly Section[], measure: Measure): Layout {
  const pen = new Pen(measure);
  pen.tabs(tab, open);
  for (const section of sections) pen.section(section);
  return { zones: pen.zones, bottom: pen.y + PAD };
}

/** Breaks a text into lines that fit. */
export function lines(text: string, size: number, width: number, measure: Measure): string[] {
  const found: string[] = [];
  for (const word of text.split(/\s+/)) {
    const last = found.at(-1);
    if (last !== undefined && measure(`${last} ${word}`, size) <= width) found[found.length - 1] = `${last} ${word}`;
    else found.push(word);
  }
  return found;
}

class Pen {
  readonly zones: Zone[] = [];
  y = TABS_HEIGHT + 8;

  constructor(private readonly measure: Measure) {}

  tabs(tab: TabId, open: (tab: TabId) => void): void {
    const w = WIDTH / TABS.length;
    TABS.forEach(({ id, label, icon }, index) => {
      const press = (): void => open(id);
      this.zones.push({
        key: `tab:${id}`,
        look: "tab",
        x: index * w,
        y: 0,
        w,
        h: TABS_HEIGHT,
        lines: [label],
        icon,
        on: id === tab,
        press,
      });
    });
  }

  section({ id, title, widgets }: Section): void {
    this.y += 20;
    if (title) this.text(`${id}:title`, title, SIZE.small, "heading");
    for (const widget of widgets) this.widget(widget, id);
  }

  private widget(widget: Widget, section: string): void {
    const key = `${section}/${widget.id}`;
    switch (widget.kind) {
      case "button":
        return this.row(key, [widget]);
      case "row":
        return this.row(key, widget.buttons);
      case "toggle":
        return this.full(
          key,
          "toggle",
          {
            lines: [widget.label],
            detail: widget.hint,
            on: widget.on,
            disabled: widget.disabled,
            press: () => widget.set(!widget.on),
          },
          widget.hint ? 92 : ROW,
        );
      case "choice":
        return this.choice(key, widget);
      case "slider": {
        const slide = (position: number, done: boolean): void =>
          done ? widget.commit(position) : widget.input?.(position);
        const text = (position: number): string => widget.text(position);
        return this.full(
          key,
          "slider",
          { lines: [widget.label], position: widget.position, disabled: widget.disabled, slide, text },
          104,
        );
      }
      case "item":
        return this.full(
          key,
          "item",
          {
            lines: [this.cut(widget.title, SIZE.body, INNER - 120)],
            detail: this.cut(widget.detail, SIZE.small, INNER - 120),
            number: widget.number,
            tone: widget.tone,
            on: widget.chosen,
            press: () => widget.choose(),
          },
          84,
          6,
        );
      case "drag":
        return this.full(
          key,
          "drag",
          { lines: [widget.label], detail: "Take it, and put it on a floor", disabled: widget.disabled },
          104,
        );
      case "note":
        return this.text(key, widget.text, widget.tone === "title" ? SIZE.title : SIZE.body, "text", widget.tone);
      case "legend":
        return this.full(key, "legend", { lines: [widget.low, widget.high] }, 76);
      case "scale":
        return this.scale(key, widget);
      case "stepper":
        return this.stepper(key, widget);
    }
  }

  private full(key: string, look: Look, zone: Partial<Zone>, h: number, gap = GAP): void {
    this.zones.push({ key, look, x: PAD, y: this.y, w: INNER, h, lines: [], ...zone });
    this.y += h + gap;
  }

  private text(key: string, text: string, size: number, look: Look, tone?: string): void {
    const bold = tone === "title" || look === "heading";
    const broken = lines(text, size, bold ? INNER / BOLD : INNER, this.measure);
    this.full(
      key,
      look,
      { lines: broken, tone },
      Math.ceil(broken.length * size * LINE),
      look === "heading" ? 10 : GAP,
    );
  }

  private cut(text: string, size: number, width: number): string {
    if (this.measure(text, size) <= width) return text;
    let end = text.length;
    while (end > 1 && this.measure(`${text.slice(0, end)}…`, size) > width) end--;
    return `${text.slice(0, end)}…`;
  }

  private row(key: string, buttons: readonly Button[]): void {
    const gap = 12;
    const w = (INNER - gap * (buttons.length - 1)) / buttons.length;
    const needed = buttons.map(({ label, icon, compact }) =>
      compact ? 0 : this.measure(label, SIZE.body) + (icon ? 48 : 0) + 32,
    );
    if (buttons.length > 1 && needed.some((one) => one > w)) {
      for (const button of buttons) this.row(`${key}:${button.id}`, [button]);
      return;
    }
    buttons.forEach((button, index) => {
      const { label, icon, compact, pressed, disabled, tone } = button;
      const shown = compact ? [] : [this.cut(label, SIZE.body, w - 24)];
      const place = { x: PAD + index * (w + gap), y: this.y, w, h: ROW };
      this.zones.push({
        key: `${key}:${button.id}`,
        look: "button",
        ...place,
        lines: shown,
        icon,
        on: pressed,
        disabled,
        tone,
        press: () => button.run(),
      });
    });
    this.y += ROW + GAP;
  }

  private choice(key: string, { options, value, disabled, choose }: Extract<Widget, { kind: "choice" }>): void {
    const gap = 6;
    // As many in a line as fit with their texts.
    const widest = Math.max(...options.map(({ label }) => this.measure(label, SIZE.body))) + 36;
    const most = Math.min(options.length, Math.max(1, Math.floor((INNER + gap) / (widest + gap))));
    // Lines of one length: none of them holds a single one that is left over.
    const across = Math.ceil(options.length / Math.ceil(options.length / most));
    const w = (INNER - gap * (across - 1)) / across;
    options.forEach((option, index) => {
      const place = {
        x: PAD + (index % across) * (w + gap),
        y: this.y + Math.floor(index / across) * (ROW + gap),
        w,
        h: ROW,
      };
      const press = (): void => choose(option.value);
      this.zones.push({
        key: `${key}:${option.value}`,
        look: "segment",
        ...place,
        lines: [option.label],
        on: option.value === value,
        disabled,
        press,
      });
    });
    this.y += Math.ceil(options.length / across) * (ROW + gap) + GAP - gap;
  }

  private scale(key: string, { question, ends, count, value, text, choose }: Extract<Widget, { kind: "scale" }>): void {
    this.text(`${key}:question`, question, SIZE.title, "text", "title");
    const w = INNER / count;
    const words = w > MARKS_LEAST * 2;
    for (let index = 0; index < count; index++) {
      const press = (): void => choose(index);
      const place = { x: PAD + index * w, y: this.y, w, h: 100 };
      this.zones.push({
        key: `${key}:${index}`,
        look: "mark",
        ...place,
        lines: words ? [text(index)] : [],
        on: index === value,
        press,
      });
    }
    this.y += 108;
    this.full(`${key}:ends`, "legend", { lines: ends, tone: "bare" }, 40);
  }

  private stepper(key: string, { label, value, disabled, step }: Extract<Widget, { kind: "stepper" }>): void {
    const [h, y] = [ROW, this.y];
    const less = WIDTH - PAD - 440;
    this.zones.push({ key, look: "text", x: PAD, y: y + 18, w: less - PAD, h: 44, lines: [label] });
    this.zones.push({
      key: `${key}:less`,
      look: "button",
      x: less,
      y,
      w: 90,
      h,
      lines: [],
      icon: "minus",
      disabled,
      press: () => step(-1),
    });
    this.zones.push({
      key: `${key}:value`,
      look: "value",
      x: less + 96,
      y,
      w: 248,
      h,
      lines: [this.cut(value, SIZE.body, 240)],
    });
    this.zones.push({
      key: `${key}:more`,
      look: "button",
      x: WIDTH - PAD - 90,
      y,
      w: 90,
      h,
      lines: [],
      icon: "plus",
      disabled,
      press: () => step(1),
    });
    this.y += h + GAP;
  }
}
