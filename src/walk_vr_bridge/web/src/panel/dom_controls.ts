// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The controls of the panel as elements: made once, brought up to date afterwards, so that focus and drags survive. */

import { element, icon, setText } from "./element";
import type * as w from "./widgets";

/** A widget on the page. `update` takes the widget as it is now. */
export interface Shown<W extends w.Widget = w.Widget> {
  readonly root: HTMLElement;
  update(widget: W): void;
}

export function buttonOf(): Shown<w.Button> {
  const root = element("button");
  root.type = "button";
  let now: w.Button;
  let drawn = "";
  root.addEventListener("click", () => now.run());
  return {
    root,
    update(widget) {
      now = widget;
      const { label, tone = "plain", compact = false, pressed, disabled = false } = widget;
      root.className = `button ${tone}${compact ? " compact" : ""}`;
      root.disabled = disabled;
      root.dataset.id = widget.id;
      if (pressed === undefined) root.removeAttribute("aria-pressed");
      else root.setAttribute("aria-pressed", String(pressed));
      const look = `${widget.icon}|${label}|${compact}`;
      if (look === drawn) return;
      drawn = look;
      root.replaceChildren(
        ...(widget.icon ? [icon(widget.icon)] : []),
        ...(compact ? [] : [element("span", "", label)]),
      );
      root.title = compact ? label : "";
      root.setAttribute("aria-label", label);
    },
  };
}

export function rowOf(): Shown<w.Row> {
  const root = element("div", "row");
  const shown = new Map<string, Shown<w.Button>>();
  return {
    root,
    update({ buttons }) {
      for (const id of [...shown.keys()]) {
        if (!buttons.some((one) => one.id === id)) {
          shown.get(id)!.root.remove();
          shown.delete(id);
        }
      }
      buttons.forEach((one, index) => {
        const made = shown.get(one.id) ?? buttonOf();
        shown.set(one.id, made);
        made.update(one);
        if (root.children[index] !== made.root) root.insertBefore(made.root, root.children[index] ?? null);
      });
    },
  };
}

export function toggleOf(): Shown<w.Toggle> {
  const root = element("button", "toggle");
  const [words, hint] = [element("span", "words"), element("span", "hint")];
  const label = element("span", "label");
  words.append(label, hint);
  root.append(words, element("span", "knob"));
  root.type = "button";
  root.setAttribute("role", "switch");
  let now: w.Toggle;
  root.addEventListener("click", () => now.set(!now.on));
  return {
    root,
    update(widget) {
      now = widget;
      root.dataset.id = widget.id;
      root.disabled = widget.disabled ?? false;
      root.setAttribute("aria-checked", String(widget.on));
      setText(label, widget.label);
      setText(hint, widget.hint ?? "");
    },
  };
}

export function choiceOf(): Shown<w.Choice> {
  const root = element("div", "choice");
  root.setAttribute("role", "group");
  let now: w.Choice;
  let drawn = "";
  return {
    root,
    update(widget) {
      now = widget;
      root.dataset.id = widget.id;
      root.setAttribute("aria-label", widget.label);
      const look = JSON.stringify(widget.options);
      if (look !== drawn) {
        drawn = look;
        root.replaceChildren(
          ...widget.options.map(({ value, label }) => {
            const option = element("button", "", label);
            option.type = "button";
            option.dataset.value = value;
            option.addEventListener("click", () => now.choose(value));
            return option;
          }),
        );
      }
      for (const option of root.children as HTMLCollectionOf<HTMLButtonElement>) {
        option.setAttribute("aria-pressed", String(option.dataset.value === widget.value));
        option.disabled = widget.disabled ?? false;
      }
    },
  };
}

export function sliderOf(): Shown<w.Slider> {
  const root = element("label", "slider");
  // The value is no <output>: the label would belong to it, as the first of its controls.
  const [label, value, range] = [element("span", "label"), element("span", "value"), element("input")];
  root.append(label, value, range);
  Object.assign(range, { type: "range", min: "0", max: "1", step: "any" });
  let now: w.Slider;
  let sliding = false;
  const show = (position: number): void => {
    setText(value, now.text(position));
    range.setAttribute("aria-valuetext", now.text(position));
    range.style.setProperty("--share", String(position));
  };
  range.addEventListener("input", () => {
    sliding = true;
    show(range.valueAsNumber);
    now.input?.(range.valueAsNumber);
  });
  range.addEventListener("change", () => {
    sliding = false;
    now.commit(range.valueAsNumber);
  });
  range.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    range.valueAsNumber = Math.min(1, Math.max(0, range.valueAsNumber + by * now.step));
    show(range.valueAsNumber);
    now.commit(range.valueAsNumber);
  });
  return {
    root,
    update(widget) {
      now = widget;
      root.dataset.id = widget.id;
      root.title = widget.hint ?? "";
      range.disabled = widget.disabled ?? false;
      range.setAttribute("aria-label", widget.label);
      setText(label, widget.label);
      if (sliding) return;
      range.valueAsNumber = widget.position;
      show(widget.position);
    },
  };
}
