// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** A way of looking at the building with mouse and keyboard: around it, from above, or from inside. */

import type { Camera } from "three";

export type ViewpointName = "orbit" | "plan" | "walk";

export interface Viewpoint {
  readonly name: ViewpointName;
  /** What the picture is drawn through. */
  readonly camera: Camera;
  /** Takes over the camera. */
  enter(): void;
  leave(): void;
  /** Once a frame while it has the camera. */
  frame(seconds: number): void;
  /** Looks at the whole building, or the storey that is shown. */
  fit(): void;
  /** The pointer was dragged over nothing that can be held, by so many pixels of the page. */
  drag(dx: number, dy: number, pan: boolean): void;
  /** Nearer (below 1) or farther (above 1), towards the place of the page under the pointer. */
  zoom(factor: number, clientX: number, clientY: number): void;
}
