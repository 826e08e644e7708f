// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** What the study compares and asks: two conditions in counter-balanced order, with the same tasks in each. */

export type Condition = "optimiser_off" | "optimiser_on";

export const CONDITION_TITLES: Readonly<Record<Condition, string>> = {
  optimiser_off: "Optimiser off",
  optimiser_on: "Optimiser on",
};

export interface Task {
  readonly id: string;
  readonly title: string;
  readonly text: string;
}

/** Our own tasks; the questionnaires are the instruments' own. */
export const TASKS: readonly Task[] = [
  {
    id: "cover",
    title: "Show the building",
    text: "Move the keypoints so that the tour shows a visitor every room of the storey you are on.",
  },
  {
    id: "comfort",
    title: "Make it pleasant",
    text: "Find a place where the tour comes close to a wall or to furniture, and change it so that it does not.",
  },
  {
    id: "highlight",
    title: "End at the best place",
    text: "Add a keypoint where you would want the visit to end, and make it the end of the tour.",
  },
];

/** Returns the order of the conditions: participants 1, 3, 5 … begin without the optimiser, 2, 4, 6 … with it. */
export function orderOf(participant: number): readonly [Condition, Condition] {
  if (!Number.isInteger(participant) || participant < 1) {
    throw new RangeError(`a participant has a whole number from 1, not ${participant}`);
  }
  return participant % 2 === 1 ? ["optimiser_off", "optimiser_on"] : ["optimiser_on", "optimiser_off"];
}
