// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import "./page.css";
import { View } from "./scene/view";

const canvas = document.querySelector<HTMLCanvasElement>("#view");
if (canvas) new View(canvas).start();
