// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The strokes that the panel's picture is drawn with. */

import { ICONS, type IconName } from "./icons";
import { SIZE, type Zone } from "./sheet";

const FONT = 'Inter, "Segoe UI", system-ui, "Noto Sans", "Liberation Sans", "DejaVu Sans", sans-serif';

export function font(size: number, weight = 400): string {
  return `${weight} ${size}px ${FONT}`;
}

export function round(
  pen: CanvasRenderingContext2D,
  x: number,
  y: number,
  w: number,
  h: number,
  radius: number,
  fill: string,
  edge = "",
): void {
  pen.beginPath();
  pen.roundRect(x, y, w, h, radius);
  pen.fillStyle = fill;
  pen.fill();
  if (!edge) return;
  pen.strokeStyle = edge;
  pen.lineWidth = 3;
  pen.stroke();
}

export function write(
  pen: CanvasRenderingContext2D,
  lines: readonly string[],
  x: number,
  y: number,
  size: number,
  colour: string,
  weight = 400,
): void {
  pen.font = font(size, weight);
  pen.fillStyle = colour;
  pen.textAlign = "left";
  pen.textBaseline = "top";
  lines.forEach((line, index) => pen.fillText(line, x, y + index * size * 1.32));
}

export function centred(pen: CanvasRenderingContext2D, text: string, zone: Zone, colour: string, weight = 500): void {
  pen.font = font(SIZE.body, weight);
  pen.fillStyle = colour;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(text, zone.x + zone.w / 2, zone.y + zone.h / 2 + 1);
}

export function drawIcon(
  pen: CanvasRenderingContext2D,
  name: IconName,
  x: number,
  y: number,
  size: number,
  colour: string,
): void {
  pen.save();
  pen.translate(x, y);
  pen.scale(size / 24, size / 24);
  pen.strokeStyle = colour;
  pen.lineWidth = 1.9;
  pen.lineCap = pen.lineJoin = "round";
  pen.stroke(new Path2D(ICONS[name]));
  pen.restore();
}
