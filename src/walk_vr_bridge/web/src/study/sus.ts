// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The System Usability Scale: ten items, its wording and its score (`brooke1996`). */

/** The items in the order of the instrument; odd ones speak for the system, even ones against it. */
export const SUS_ITEMS: readonly string[] = [
  "I think that I would like to use this system frequently.",
  "I found the system unnecessarily complex.",
  "I thought the system was easy to use.",
  "I think that I would need the support of a technical person to be able to use this system.",
  "I found the various functions in this system were well integrated.",
  "I thought there was too much inconsistency in this system.",
  "I would imagine that most people would learn to use this system very quickly.",
  "I found the system very cumbersome to use.",
  "I felt very confident using the system.",
  "I needed to learn a lot of things before I could get going with this system.",
];

/** What the ends of the five-point scale say. */
export const SUS_ENDS: readonly [string, string] = ["Strongly disagree", "Strongly agree"];

export const SUS_POINTS = 5;

/** What an item without an answer counts as: the middle of the scale, as the instrument prescribes. */
export const SUS_MIDDLE = 3;

/**
 * Returns the score, 0 (worst) to 100, of ten answers from 1 (strongly disagree) to 5 (strongly agree).
 *
 * Odd items contribute their answer less 1, even items 5 less their answer; the sum is multiplied by 2.5. An item that
 * was left out (null) counts as the middle. The result is no percentage.
 *
 * @throws RangeError where there are not ten answers or one is no whole number from 1 to 5.
 */
export function susScore(answers: readonly (number | null)[]): number {
  if (answers.length !== SUS_ITEMS.length) {
    throw new RangeError(`the SUS has ${SUS_ITEMS.length} items, but there are ${answers.length} answers`);
  }
  let sum = 0;
  answers.forEach((given, index) => {
    const answer = given ?? SUS_MIDDLE;
    if (!Number.isInteger(answer) || answer < 1 || answer > SUS_POINTS) {
      throw new RangeError(`SUS item ${index + 1} takes a whole number from 1 to ${SUS_POINTS}, not ${answer}`);
    }
    sum += index % 2 === 0 ? answer - 1 : SUS_POINTS - answer;
  });
  return sum * 2.5;
}
