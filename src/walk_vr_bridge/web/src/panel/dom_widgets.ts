// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Each kind of widget as elements: made once, brought up to date afterwards, so that focus and drags survive. */

import { element, icon, setText } from "./element";
import type * as w from "./widgets";

/** A widget on the page. `update` takes the widget as it is now. */
export interface Shown<W extends w.Widget = w.Widget> {
  readonly root: HTMLElement;
  update(widget: W): void;
}

export interface DomPort {
  /** A drag out of the panel begins with this pointer. */
  dragOut(event: PointerEvent): void;
}

type Makers = { [K in w.Widget["kind"]]: (port: DomPort) => Shown<Extract<w.Widget, { kind: K }>> };

function buttonOf(): Shown<w.Button> {
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
      root.replaceChildren(...(widget.icon ? [icon(widget.icon)] : []), ...(compact ? [] : [element("span", "", label)]));
      root.title = compact ? label : "";
      root.setAttribute("aria-label", label);
    },
  };
}

function rowOf(): Shown<w.Row> {
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

function toggleOf(): Shown<w.Toggle> {
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

function choiceOf(): Shown<w.Choice> {
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

function sliderOf(): Shown<w.Slider> {
  const root = element("label", "slider");
  const [label, value, range] = [element("span", "label"), element("output"), element("input")];
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
      setText(label, widget.label);
      if (sliding) return;
      range.valueAsNumber = widget.position;
      show(widget.position);
    },
  };
}

function itemOf(): Shown<w.Item> {
  const root = element("button", "item");
  const [number, title, detail] = [element("span", "number"), element("span", "title"), element("span", "detail")];
  const words = element("span", "words");
  words.append(title, detail);
  root.append(number, words);
  root.type = "button";
  let now: w.Item;
  root.addEventListener("click", () => now.choose());
  return {
    root,
    update(widget) {
      if (widget.chosen && !root.classList.contains("chosen")) requestAnimationFrame(() => root.scrollIntoView({ block: "nearest" }));
      now = widget;
      root.dataset.id = widget.id;
      root.className = `item ${widget.tone}${widget.chosen ? " chosen" : ""}`;
      root.setAttribute("aria-expanded", String(widget.chosen));
      setText(number, widget.number);
      setText(title, widget.title);
      setText(detail, widget.detail);
    },
  };
}

function dragOf(port: DomPort): Shown<w.DragSource> {
  const root = element("button", "drag-source");
  const [label, hint] = [element("span", "label"), element("span", "hint")];
  const words = element("span", "words");
  words.append(label, hint);
  root.append(element("span", "pin"), words);
  root.type = "button";
  let now: w.DragSource;
  root.addEventListener("pointerdown", (event) => port.dragOut(event));
  root.addEventListener("click", () => now.run());
  return {
    root,
    update(widget) {
      now = widget;
      root.dataset.id = widget.id;
      root.disabled = widget.disabled ?? false;
      setText(label, widget.label);
      setText(hint, widget.hint);
    },
  };
}

function noteOf(): Shown<w.Note> {
  const root = element("p");
  return {
    root,
    update({ id, text, tone }) {
      root.dataset.id = id;
      root.className = `note ${tone}`;
      if (tone === "warn" || tone === "good") root.setAttribute("role", "status");
      setText(root, text);
    },
  };
}

function legendOf(): Shown<w.Legend> {
  const root = element("div", "legend");
  const [low, high] = [element("span"), element("span")];
  root.append(element("span", "bar"), low, high);
  return {
    root,
    update(widget) {
      root.dataset.id = widget.id;
      setText(low, widget.low);
      setText(high, widget.high);
    },
  };
}

function scaleOf(): Shown<w.Scale> {
  const root = element("fieldset", "scale");
  const question = element("legend", "question");
  const marks = element("div", "marks");
  const ends = element("div", "ends");
  const [low, high] = [element("span"), element("span")];
  ends.append(low, high);
  root.append(question, marks, ends);
  let now: w.Scale;
  return {
    root,
    update(widget) {
      now = widget;
      root.dataset.id = widget.id;
      setText(question, widget.question);
      setText(low, widget.ends[0]);
      setText(high, widget.ends[1]);
      marks.classList.toggle("fine", widget.count > 7);
      while (marks.children.length < widget.count) {
        const index = marks.children.length;
        const mark = element("button");
        mark.type = "button";
        mark.addEventListener("click", () => now.choose(index));
        marks.append(mark);
      }
      while (marks.children.length > widget.count) marks.lastChild?.remove();
      Array.from(marks.children).forEach((mark, index) => {
        mark.setAttribute("aria-pressed", String(index === widget.value));
        mark.setAttribute("aria-label", widget.text(index));
        setText(mark, widget.count > 7 ? "" : widget.text(index));
      });
    },
  };
}

function stepperOf(): Shown<w.Stepper> {
  const root = element("div", "stepper");
  const [label, value] = [element("span", "label"), element("output")];
  const [less, more] = [buttonOf(), buttonOf()];
  root.append(label, less.root, value, more.root);
  return {
    root,
    update(widget) {
      root.dataset.id = widget.id;
      const { disabled = false } = widget;
      const common = { kind: "button", compact: true, disabled } as const;
      less.update({ ...common, id: "less", label: `${widget.label}: less`, icon: "minus", run: () => widget.step(-1) });
      more.update({ ...common, id: "more", label: `${widget.label}: more`, icon: "plus", run: () => widget.step(1) });
      setText(label, widget.label);
      setText(value, widget.value);
    },
  };
}

const MAKERS: Makers = {
  button: buttonOf,
  row: rowOf,
  toggle: toggleOf,
  choice: choiceOf,
  slider: sliderOf,
  item: itemOf,
  drag: dragOf,
  note: noteOf,
  legend: legendOf,
  scale: scaleOf,
  stepper: stepperOf,
};

/** Makes the elements of a widget and fills them in. */
export function makeWidget(widget: w.Widget, port: DomPort): Shown {
  const shown = MAKERS[widget.kind](port) as Shown;
  shown.update(widget);
  return shown;
}
