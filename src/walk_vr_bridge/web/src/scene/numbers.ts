// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BufferAttribute, BufferGeometry, CanvasTexture, DynamicDrawUsage, InstancedBufferAttribute } from "three";
import { InstancedMesh, Matrix4, ShaderMaterial, SRGBColorSpace } from "three";
import type { Keypoint } from "../client/state";
import { MAX_PINS, type Showing } from "./pins";

const CELLS = 16;
const CELL = 64;

const VERTEX = `
attribute float aCell;
uniform float uSize;
varying vec2 vUv;
void main() {
  vec2 cell = vec2(mod(aCell, ${CELLS.toFixed(1)}), floor(aCell / ${CELLS.toFixed(1)}));
  vUv = (cell + vec2(position.x + 0.5, 0.5 - position.y)) / ${CELLS.toFixed(1)};
  vec4 middle = modelViewMatrix * instanceMatrix * vec4(0.0, 0.0, uSize * 2.4, 1.0);
  float scale = length(modelViewMatrix[0].xyz) * uSize * 2.6;
  middle.xy += position.xy * scale;
  gl_Position = projectionMatrix * middle;
}`;
const FRAGMENT = `
uniform sampler2D uDigits;
varying vec2 vUv;
void main() {
  gl_FragColor = texture2D(uDigits, vUv);
  if (gl_FragColor.a < 0.05) discard;
  #include <colorspace_fragment>
}`;

/** The place of each keypoint in the tour, as a number over its ball that faces the viewer: one draw call. */
export class Numbers {
  readonly mesh: InstancedMesh<BufferGeometry, ShaderMaterial>;
  private readonly cells = new InstancedBufferAttribute(new Float32Array(MAX_PINS), 1);

  /** @param throughWalls whether numbers are seen although something hides their keypoint. */
  constructor(throughWalls: boolean) {
    const quad = new BufferGeometry();
    const corners = new Float32Array([-0.5, -0.5, 0, 0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, 0.5, 0]);
    quad.setAttribute("position", new BufferAttribute(corners, 3));
    quad.setAttribute("aCell", this.cells);
    quad.setIndex([0, 1, 2, 0, 2, 3]);
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthTest: !throughWalls,
      depthWrite: false,
      uniforms: { uDigits: { value: digits() }, uSize: { value: 0.1 } },
    });
    this.mesh = new InstancedMesh(quad, material, MAX_PINS);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.cells.setUsage(DynamicDrawUsage);
    this.mesh.count = 0;
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 40;
  }

  setSize(radiusM: number): void {
    this.mesh.material.uniforms.uSize.value = radiusM;
  }

  /** Numbers count those that the tour visits; what is dimmed or left out by the tour has none. */
  update(keypoints: readonly Keypoint[], showing: (keypoint: Keypoint) => Showing): void {
    let count = 0;
    let rank = 0;
    for (const keypoint of keypoints) {
      if (keypoint.unreachable) continue;
      rank += 1;
      if (count >= MAX_PINS || rank >= CELLS * CELLS || showing(keypoint) !== "plain") continue;
      const [x, y, z] = keypoint.position;
      this.mesh.setMatrixAt(count, PLACE.makeTranslation(x, y, z));
      this.cells.setX(count, rank);
      count += 1;
    }
    this.mesh.count = count;
    this.mesh.visible = count > 0;
    this.mesh.instanceMatrix.needsUpdate = true;
    this.cells.needsUpdate = true;
  }
}

let shared: CanvasTexture | null = null;

/** All numbers that can occur, drawn once. */
function digits(): CanvasTexture {
  if (shared) return shared;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = CELLS * CELL;
  const pen = canvas.getContext("2d");
  if (pen) {
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.lineJoin = "round";
    for (let value = 0; value < CELLS * CELLS; value++) drawNumber(pen, value);
  }
  shared = new CanvasTexture(canvas);
  shared.flipY = false;
  shared.colorSpace = SRGBColorSpace;
  return shared;
}

function drawNumber(pen: CanvasRenderingContext2D, value: number): void {
  const x = (value % CELLS) * CELL + CELL / 2;
  const y = Math.floor(value / CELLS) * CELL + CELL / 2;
  pen.font = `600 ${value > 99 ? 28 : 38}px system-ui, "Noto Sans", "DejaVu Sans", sans-serif`;
  pen.lineWidth = 9;
  pen.strokeStyle = "rgba(20, 28, 38, 0.95)";
  pen.fillStyle = "#ffffff";
  pen.strokeText(String(value), x, y);
  pen.fillText(String(value), x, y);
}

const PLACE = new Matrix4();
