// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The Tour tab: add keypoints, the list of them, what can be done with the chosen one, the order, and history. */

import type { Actions } from "../client/actions";
import { button } from "./buttons";
import type { Keypoint, Parameter, State } from "../client/state";
import type { Item, Section, Widget } from "./widgets";

/** A stay is set in these steps [s]. */
const DWELL_STEPS = [0, 1, 2, 3, 5, 8, 10, 15, 20, 30, 45, 60, 120];
/** A shorter tour than this is not worth an offer [m]. */
const WORTH_M = 0.1;
/** What is not locked the walk passes within half a metre, which "stays" alone would not say. */
const LOCK = "Lock: stays here, the walk passes exactly through";
const UNLOCK = "Unlock: can be moved, the walk may pass beside";

export function tourSections(state: State, actions: Actions): Section[] {
  const editor = state.session.role === "editor";
  return [
    { id: "add", title: "Add", widgets: editor ? addWidgets(state, actions) : [] },
    { id: "history", title: "", widgets: editor ? [historyRow(actions)] : [] },
    { id: "order", title: "Order", widgets: editor ? orderWidgets(state, actions) : [] },
    { id: "keypoints", title: keypointsTitle(state), widgets: keypointWidgets(state, actions, editor) },
  ];
}

function addWidgets(state: State, actions: Actions): Widget[] {
  const adding = state.selection.tool === "add";
  return [
    {
      kind: "drag",
      id: "add",
      label: adding ? "Click a floor …" : "New keypoint",
      hint: adding ? "Esc or click here to stop" : "Drag it onto a floor, or press and click there",
      run: () => actions.useTool(adding ? "edit" : "add"),
    },
    {
      kind: "toggle",
      id: "add-near",
      label: "Find the best place around",
      on: state.settings.addNear,
      set: (on) => actions.set({ addNear: on }),
    },
  ];
}

function historyRow(actions: Actions): Widget {
  const undo = button("undo", "Undo", () => void actions.undo(), { icon: "undo" });
  const redo = button("redo", "Redo", () => void actions.redo(), { icon: "redo" });
  return { kind: "row", id: "history", buttons: [undo, redo] };
}

/** How the sequencer finds the order; `given` is the user's own. */
export const METHOD = "sequencer.method";

function orderWidgets({ parameters, offer }: State, actions: Actions): Widget[] {
  const method = parameters.find(({ name }) => name === METHOD);
  const widgets: Widget[] = [];
  if (method) widgets.push(orderChoice(method, actions));
  const saves = offer.betterOrderSavesM;
  if (saves > WORTH_M) {
    const run = (): void => void actions.replan();
    widgets.push(button("replan", `Take a better order: ${saves.toFixed(1)} m shorter`, run, { tone: "primary" }));
  } else {
    widgets.push(button("replan", "Look for a better order", () => void actions.replan(), { icon: "route" }));
  }
  return widgets;
}

function orderChoice(method: Parameter, actions: Actions): Widget {
  return {
    kind: "choice",
    id: "order",
    label: "Order of the tour",
    value: method.value === "given" ? "given" : "auto",
    options: [
      { value: "given", label: "As I set it" },
      { value: "auto", label: "Automatic" },
    ],
    choose: (value) => void actions.setParameter(method, value),
  };
}

function keypointsTitle({ keypoints, path }: State): string {
  const length = path.count > 0 ? ` · ${path.lengthM.toFixed(0)} m` : "";
  return `${keypoints.length} keypoint${keypoints.length === 1 ? "" : "s"}${length}`;
}

function keypointWidgets(state: State, actions: Actions, editor: boolean): Widget[] {
  const { keypoints, selection } = state;
  if (keypoints.length === 0) {
    const text = "There are no keypoints yet. They appear when the building has been looked through; or add your own.";
    return [{ kind: "note", id: "none", text, tone: "plain" }];
  }
  return keypoints.flatMap((keypoint, index) => {
    const item = itemOf(keypoint, index, selection.keypoint === keypoint.id, actions);
    return editor && item.chosen ? [item, ...chosenWidgets(keypoint, state, actions)] : [item];
  });
}

function itemOf(keypoint: Keypoint, index: number, chosen: boolean, actions: Actions): Item {
  const { id, label, locked, start, end, dwellS, lookAt, unreachable, pending } = keypoint;
  const marks = [
    start && "start",
    end && "end",
    locked && "locked",
    dwellS !== null && `stays ${dwellS} s`,
    lookAt && "looks at a point",
    pending && "moving …",
  ];
  return {
    kind: "item",
    id: `keypoint:${id}`,
    number: String(index + 1),
    title: label || `Keypoint ${index + 1}`,
    detail: unreachable || marks.filter(Boolean).join(" · "),
    tone: unreachable ? "warn" : start ? "start" : end ? "end" : "plain",
    chosen,
    choose: () => (chosen ? actions.select(null) : actions.reveal(id)),
  };
}

function chosenWidgets(keypoint: Keypoint, state: State, actions: Actions): Widget[] {
  const { id, locked, start, end, lookAt } = keypoint;
  const compact = { compact: true } as const;
  const aiming = state.selection.tool === "lookAt";
  const lock = (): void => void (locked ? actions.unlock(id) : actions.lock(id));
  return [
    {
      kind: "row",
      id: `chosen:${id}`,
      buttons: [
        button("lock", locked ? UNLOCK : LOCK, lock, {
          ...compact,
          icon: locked ? "lock" : "unlock",
          pressed: locked,
        }),
        button(
          "start",
          start ? "No longer the start" : "Start here",
          () => void (start ? actions.freeEnd(id) : actions.setStart(id)),
          { ...compact, icon: "start", pressed: start },
        ),
        button(
          "end",
          end ? "No longer the end" : "End here",
          () => void (end ? actions.freeEnd(id) : actions.setEnd(id)),
          { ...compact, icon: "end", pressed: end },
        ),
        button("earlier", "Earlier in the tour", () => void actions.reorder(id, "earlier"), { ...compact, icon: "up" }),
        button("later", "Later in the tour", () => void actions.reorder(id, "later"), { ...compact, icon: "down" }),
        button("half-way", "Add one half-way to the next", () => void actions.insertHalfWay(id), {
          ...compact,
          icon: "plus",
        }),
        button("delete", "Delete", () => void actions.remove(id), { ...compact, icon: "trash", tone: "danger" }),
      ],
    },
    dwellStepper(keypoint, actions),
    {
      kind: "row",
      id: `look:${id}`,
      buttons: [
        button(
          "look-at",
          aiming ? "Point at something …" : "Look at …",
          () => actions.useTool(aiming ? "edit" : "lookAt"),
          { icon: "target", pressed: aiming },
        ),
        button("look-ahead", "Look ahead", () => void actions.lookAt(id, null), { disabled: lookAt === null }),
      ],
    },
  ];
}

function dwellStepper({ id, dwellS }: Keypoint, actions: Actions): Widget {
  return {
    kind: "stepper",
    id: `dwell:${id}`,
    label: "Stay",
    value: dwellS === null ? "as set for all" : dwellS === 0 ? "walk through" : `${dwellS} s`,
    step: (by) => void actions.dwell(id, nextDwell(dwellS, by)),
  };
}

/** The next stay in the row of them; below the lowest it is as set for all (null). */
export function nextDwell(dwellS: number | null, by: 1 | -1): number | null {
  if (dwellS === null) return by === 1 ? DWELL_STEPS[1]! : 0;
  if (by === 1) return DWELL_STEPS.find((step) => step > dwellS) ?? dwellS;
  const lower = DWELL_STEPS.filter((step) => step < dwellS);
  return lower.length > 0 ? lower[lower.length - 1]! : null;
}
