// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** Each kind of widget as elements: made once, brought up to date afterwards, so that focus and drags survive. */

import { buttonOf, choiceOf, rowOf, type Shown, sliderOf, toggleOf } from "./dom_controls";
import { element, setText } from "./element";
import type * as w from "./widgets";

export interface DomPort {
  /** A drag out of the panel begins with this pointer. */
  dragOut(event: PointerEvent): void;
}

type Makers = { [K in w.Widget["kind"]]: (port: DomPort) => Shown<Extract<w.Widget, { kind: K }>> };

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
      if (widget.chosen && !root.classList.contains("chosen"))
        requestAnimationFrame(() => root.scrollIntoView({ block: "nearest" }));
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
      if (tone === "warn" || tone === "wait" || tone === "good") root.setAttribute("role", "status");
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
