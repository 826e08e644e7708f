// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Color, DynamicDrawUsage, Group, InstancedMesh, Matrix4, Quaternion, ShaderMaterial, Vector3 } from "three";
import type { Keypoint } from "../client/state";
import { headingOf } from "./axes";
import { KEYPOINT } from "./palette";
import { makePin } from "./pin";

export const MAX_PINS = 256;
/** How solid keypoints are that are dimmed. */
export const DIM = 0.3;

const VERTEX = `
attribute float aDrop;
uniform float uSize;
uniform float uStem;
varying vec3 vTint;
varying vec3 vNormal2;
void main() {
  vTint = instanceColor;
  vec4 place = instanceMatrix * vec4(position * uSize, 1.0);
  place.z -= aDrop * uStem;
  vNormal2 = mat3(instanceMatrix) * normal;
  gl_Position = projectionMatrix * modelViewMatrix * place;
}`;
const FRAGMENT = `
uniform float uOpacity;
varying vec3 vTint;
varying vec3 vNormal2;
void main() {
  vec3 n = normalize(vNormal2);
  float light = 0.66 + 0.22 * n.z + 0.16 * max(dot(n, vec3(0.42, -0.5, 0.75)), 0.0);
  gl_FragColor = vec4(vTint * light, uOpacity);
  #include <colorspace_fragment>
}`;

/** Says of a keypoint whether it is drawn: plainly, dimmed through what hides it, or not at all. */
export type Showing = "plain" | "dimmed" | "hidden";

/** The keypoints in one place, one draw call; those that are dimmed take a second one. */
export class Pins {
  readonly group = new Group();
  private readonly plain: InstancedMesh;
  private readonly dim: InstancedMesh;

  constructor(stemM: number) {
    const pin = makePin();
    this.plain = makeMesh(pin, stemM, 1);
    this.dim = makeMesh(pin, stemM, DIM);
    this.dim.renderOrder = 31;
    this.group.add(this.plain, this.dim);
  }

  /** How solid those are that are dimmed, 0 to 1. */
  setDimmed(opacity: number): void {
    (this.dim.material as ShaderMaterial).uniforms.uOpacity.value = opacity;
  }

  get counts(): { plain: number; dimmed: number } {
    return { plain: this.plain.count, dimmed: this.dim.count };
  }

  setSize(radiusM: number): void {
    (this.plain.material as ShaderMaterial).uniforms.uSize.value = radiusM;
    (this.dim.material as ShaderMaterial).uniforms.uSize.value = radiusM;
  }

  /** Writes all of them anew; only after a change. */
  update(
    keypoints: readonly Keypoint[],
    showing: (keypoint: Keypoint) => Showing,
    hover: number | null,
    chosen: number | null,
  ): void {
    this.plain.count = this.dim.count = 0;
    for (let i = 0; i < Math.min(keypoints.length, MAX_PINS); i++) {
      const keypoint = keypoints[i];
      const how = showing(keypoint);
      if (how === "hidden") continue;
      const mesh = how === "plain" ? this.plain : this.dim;
      const [x, y, z] = keypoint.position;
      const scale = keypoint.id === hover ? 1.25 : 1;
      const [qx, qy, qz, qw] = keypoint.quat;
      TURN.setFromAxisAngle(UP, headingOf(qx, qy, qz, qw));
      PLACE.compose(AT.set(x, y, z), TURN, SIZE.setScalar(scale));
      mesh.setMatrixAt(mesh.count, PLACE);
      mesh.setColorAt(mesh.count, COLOUR.set(colourOf(keypoint, hover, chosen)));
      mesh.count += 1;
    }
    for (const mesh of [this.plain, this.dim]) {
      mesh.visible = mesh.count > 0;
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
  }
}

function colourOf(keypoint: Keypoint, hover: number | null, chosen: number | null): string {
  if (keypoint.id === hover) return KEYPOINT.hover;
  if (keypoint.id === chosen) return KEYPOINT.chosen;
  if (keypoint.unreachable) return KEYPOINT.unreachable;
  if (keypoint.start) return KEYPOINT.start;
  if (keypoint.end) return KEYPOINT.end;
  if (keypoint.pending) return KEYPOINT.pending;
  return keypoint.locked ? KEYPOINT.locked : KEYPOINT.plain;
}

function makeMesh(pin: ReturnType<typeof makePin>, stemM: number, opacity: number): InstancedMesh {
  const material = new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    transparent: opacity < 1,
    depthTest: opacity >= 1,
    depthWrite: opacity >= 1,
    uniforms: { uSize: { value: 0.15 }, uStem: { value: stemM }, uOpacity: { value: opacity } },
  });
  const mesh = new InstancedMesh(pin, material, MAX_PINS);
  mesh.setColorAt(0, COLOUR);
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  mesh.instanceColor?.setUsage(DynamicDrawUsage);
  mesh.count = 0;
  mesh.frustumCulled = false;
  return mesh;
}

const UP = new Vector3(0, 0, 1);
const AT = new Vector3();
const SIZE = new Vector3();
const TURN = new Quaternion();
const PLACE = new Matrix4();
const COLOUR = new Color();
