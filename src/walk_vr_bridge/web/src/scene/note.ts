// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { CanvasTexture, Mesh, MeshBasicMaterial, PlaneGeometry, SRGBColorSpace, Vector3 } from "three";
import type { PerspectiveCamera } from "three";

const WIDTH = 640;
const HEIGHT = 144;

/** A sentence that stands at a place in the room and faces the viewer: a refusal's reason, a keypoint's name. */
export class Note {
  readonly mesh: Mesh<PlaneGeometry, MeshBasicMaterial>;
  text = "";
  private readonly canvas = document.createElement("canvas");
  private readonly texture: CanvasTexture;
  private left = 0;
  private times = 1;

  constructor(
    private readonly ground: string,
    private readonly widthAtOneMetre = 0.3,
  ) {
    this.canvas.width = WIDTH;
    this.canvas.height = HEIGHT;
    this.texture = new CanvasTexture(this.canvas);
    this.texture.colorSpace = SRGBColorSpace;
    const material = new MeshBasicMaterial({ map: this.texture, transparent: true, depthTest: false, depthWrite: false });
    this.mesh = new Mesh(new PlaneGeometry(1, HEIGHT / WIDTH), material);
    this.mesh.renderOrder = 60;
    this.mesh.visible = false;
  }

  /**
   * Shows the sentence at a place of the room for some seconds; Infinity: until it is hidden.
   *
   * @param times how much larger than a name it is written: what is to be read through has to be.
   */
  show(text: string, room: Vector3, seconds: number, times = 1): void {
    this.times = times;
    this.mesh.position.copy(room);
    this.left = seconds;
    this.mesh.visible = true;
    if (text === this.text) return;
    this.text = text;
    this.write(text);
  }

  hide(): void {
    this.mesh.visible = false;
  }

  /** Once a frame: turns to the viewer, as wide as it needs to be to be read. */
  update(seconds: number, camera: PerspectiveCamera, eye: Vector3): void {
    if (!this.mesh.visible) return;
    this.left -= seconds;
    if (this.left <= 0) this.mesh.visible = false;
    this.mesh.quaternion.setFromRotationMatrix(camera.matrixWorld);
    const distance = Math.max(0.25, this.mesh.position.distanceTo(eye));
    this.mesh.scale.setScalar(this.times * this.widthAtOneMetre * distance);
  }

  private write(text: string): void {
    const pen = this.canvas.getContext("2d");
    if (!pen) return;
    pen.clearRect(0, 0, WIDTH, HEIGHT);
    pen.font = '500 27px system-ui, "Noto Sans", "DejaVu Sans", sans-serif';
    const lines = wrap(text, (part) => pen.measureText(part).width, WIDTH - 48).slice(0, 3);
    const wide = Math.max(...lines.map((line) => pen.measureText(line).width)) + 44;
    const tall = lines.length * 34 + 22;
    pen.fillStyle = this.ground;
    pen.beginPath();
    pen.roundRect((WIDTH - wide) / 2, (HEIGHT - tall) / 2, wide, tall, 16);
    pen.fill();
    pen.fillStyle = "#ffffff";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    lines.forEach((line, i) => pen.fillText(line, WIDTH / 2, (HEIGHT - tall) / 2 + 28 + 34 * i));
    this.texture.needsUpdate = true;
  }
}

/** Breaks a sentence into lines no wider than `most`. */
export function wrap(text: string, measure: (part: string) => number, most: number): string[] {
  const lines: string[] = [];
  let line = "";
  for (const word of text.split(/\s+/)) {
    const longer = line ? `${line} ${word}` : word;
    if (line && measure(longer) > most) {
      lines.push(line);
      line = word;
    } else line = longer;
  }
  if (line) lines.push(line);
  return lines;
}
