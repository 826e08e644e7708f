// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { byPlace } from "../../src/client/words";

const TOUR = [{ id: 12 }, { id: 3 }, { id: 1 }];

it.each([
  ["keypoint 12 is locked: unlock it first", "keypoint 1 is locked: unlock it first"],
  ["Keypoint 3 is locked", "Keypoint 2 is locked"],
  ["the tour ends at keypoint 1: free its ends first", "the tour ends at keypoint 3: free its ends first"],
  ["between keypoints 3 and 12: 2 times", "between keypoints 2 and 1: 2 times"],
  ["there is no keypoint 9", "there is no keypoint 9"],
  ["it would touch the building 3 times beside keypoint 1", "it would touch the building 3 times beside keypoint 3"],
  ["keypoints 3 m apart, keypoint 12.", "keypoints 3 m apart, keypoint 1."],
  ["suggested keypoint 3 is in a wall", "suggested keypoint 3 is in a wall"],
])("names keypoints by the numbers that are shown: %s", (reason, said) => {
  expect(byPlace(reason, TOUR)).toBe(said);
});
