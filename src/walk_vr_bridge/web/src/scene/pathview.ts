// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Color, DoubleSide, Group, Mesh, type Plane, ShaderMaterial, SRGBColorSpace } from "three";
import type { PathColour, PathState } from "../client/state";
import { writeScale } from "./colourmap";
import { PATH_COLOUR } from "./palette";
import { PathTube } from "./tube";

const VERTEX = `
#include <clipping_planes_pars_vertex>
attribute vec3 aAlong;
attribute float aEdge;
uniform float uRadius;
varying vec3 vTint;
varying float vEdge;
varying vec2 vUp;
void main() {
  vTint = color.rgb;
  vEdge = aEdge;
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  mat3 turn = mat3(modelViewMatrix);
  float scale = length(turn[2]);
  vec3 along = turn * aAlong / scale;
  vec3 aside = cross(along, isOrthographic ? vec3(0.0, 0.0, 1.0) : normalize(-mvPosition.xyz));
  // Who looks along the path sees its end: any side will do.
  aside = dot(aside, aside) > 1e-9 ? normalize(aside) : vec3(1.0, 0.0, 0.0);
  vec3 up = turn[2] / scale;
  vUp = vec2(dot(aside, up), dot(cross(aside, along), up));
  mvPosition.xyz += aside * (aEdge * uRadius * scale);
  gl_Position = projectionMatrix * mvPosition;
  #include <clipping_planes_vertex>
}`;
const FRAGMENT = `
#include <clipping_planes_pars_fragment>
uniform float uOpacity;
varying vec3 vTint;
varying float vEdge;
varying vec2 vUp;
void main() {
  #include <clipping_planes_fragment>
  float up = vUp.x * vEdge + vUp.y * sqrt(max(0.0, 1.0 - vEdge * vEdge));
  gl_FragColor = vec4(vTint * (0.78 + 0.22 * up), uOpacity);
  #include <colorspace_fragment>
}`;

/** Below this the body is held to touch the building [m]; up to the second it is painted as close. */
const TOUCHES_M = 0;
const ROOMY_M = 0.6;

/** The path in one place: the tube, and faintly what of it is hidden behind floors and walls. */
export class PathView {
  readonly group = new Group();
  private readonly materials: ShaderMaterial[] = [];

  constructor(
    tube: PathTube,
    planes: Plane[],
    private readonly seenThrough: number,
  ) {
    this.add(tube, planes, false);
    if (seenThrough > 0) this.add(tube, planes, true);
  }

  private add(tube: PathTube, planes: Plane[], hidden: boolean): void {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      vertexColors: true,
      side: DoubleSide,
      clipping: planes.length > 0,
      clippingPlanes: planes,
      transparent: hidden,
      depthTest: !hidden,
      depthWrite: !hidden,
      uniforms: { uRadius: { value: 0.03 }, uOpacity: { value: hidden ? this.seenThrough : 1 } },
    });
    const mesh = new Mesh(tube.geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = hidden ? 30 : 5;
    this.materials.push(material);
    this.group.add(mesh);
  }

  setRadius(metres: number): void {
    for (const material of this.materials) material.uniforms.uRadius.value = metres;
  }
}

const scratch = new Float32Array(3);
const plain = new Color(PATH_COLOUR);
const shade = new Color();

/** Paints the tube by what the user wants to see. */
export function paintPath(tube: PathTube, path: PathState, by: PathColour): void {
  const [low, high] = rangeOf(path, by);
  for (let ring = 0; ring < tube.rings; ring++) {
    colourAt(path, tube.rowOf[ring], by, low, high);
    tube.paint(ring, shade.r * 255, shade.g * 255, shade.b * 255);
  }
  tube.painted();
}

function colourAt(path: PathState, row: number, by: PathColour, low: number, high: number): void {
  if (by === "plain") {
    shade.copy(plain);
    return;
  }
  const value = valueAt(path, row, by);
  if (Number.isNaN(value)) {
    shade.setRGB(0.35, 0.37, 0.4);
  } else if (by === "collisions") {
    shade.set(value < TOUCHES_M ? "#e5262b" : "#2fbf71");
  } else {
    writeScale((value - low) / (high - low || 1), scratch, 0);
    shade.setRGB(scratch[0], scratch[1], scratch[2], SRGBColorSpace);
  }
}

function valueAt(path: PathState, row: number, by: PathColour): number {
  if (by === "speed") return path.speedMps[row];
  if (by === "height") return path.heightM[row];
  return path.clearanceM[row];
}

/** The values at the two ends of the scale; of clearance always the same, so that pictures compare. */
export function rangeOf(path: PathState, by: PathColour): [number, number] {
  if (by === "clearance" || by === "collisions") return [TOUCHES_M, ROOMY_M];
  let [low, high] = [Infinity, -Infinity];
  for (let row = 0; row < path.count; row++) {
    const value = valueAt(path, row, by);
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : [0, 1];
}
