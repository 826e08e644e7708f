// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BackSide, Color, DoubleSide, type Plane, ShaderMaterial, Vector3 } from "three";
import { CAP_COLOUR } from "./palette";

// All but the angle at which one looks at a triangle holds for the whole of it: its two colours, looked at along it and straight
// at it, stand at its last vertex (see facets.ts), as does the distance of its plane from the eye.
const VERTEX = `
#include <clipping_planes_pars_vertex>
#include <colorspace_pars_fragment>
attribute vec4 aKind;
uniform vec3 uSun;
uniform vec3 uEye;
flat varying vec4 vAlong;
flat varying vec3 vStraight;
varying vec3 vFromEye;
vec3 shown(vec3 light) {
  return sRGBTransferOETF(vec4(light, 1.0)).rgb;
}
void main() {
  vec3 normal = (aKind.xyz - 128.0) / 127.0;
  float away = dot(normal, uEye - position);
  // Walls of one layer are lit from both sides.
  if (away < 0.0) normal = -normal;
  float sky = normal.z * 0.5 + 0.5;
  float sun = max(dot(normal, uSun), 0.0);
  float side = abs(normal.x) * 0.06 - abs(normal.y) * 0.06;
  vec3 light = mix(vec3(0.56, 0.54, 0.53), vec3(0.76, 0.78, 0.82), sky);
  light += vec3(0.27, 0.255, 0.22) * sun + side;
  // Undersides of slabs are what ceilings look like from below.
  vec3 tint = mix(color, vec3(0.93, 0.92, 0.9), 0.75 * clamp(-2.5 * normal.z - 1.25, 0.0, 1.0));
  vAlong = vec4(shown(tint * light), abs(away));
  vStraight = shown(tint * (light + 0.10));
  vFromEye = position - uEye;
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * mvPosition;
  #include <clipping_planes_vertex>
}`;

const FRAGMENT = `
#include <clipping_planes_pars_fragment>
uniform float uOpacity;
flat varying vec4 vAlong;
flat varying vec3 vStraight;
varying vec3 vFromEye;
void main() {
  #include <clipping_planes_fragment>
  float facing = min(vAlong.w * inversesqrt(dot(vFromEye, vFromEye)), 1.0);
  gl_FragColor = vec4(mix(vAlong.rgb, vStraight, facing), uOpacity);
}`;

// What encloses nothing has no inside: its triangles go out of sight.
const CAP_VERTEX = `
#include <clipping_planes_pars_vertex>
attribute vec4 aKind;
uniform float uNearer;
void main() {
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  mvPosition.z += uNearer * length(modelViewMatrix[2].xyz);
  gl_Position = aKind.w > 0.5 ? projectionMatrix * mvPosition : vec4(0.0, 0.0, 2.0, 1.0);
  #include <clipping_planes_vertex>
}`;
const CAP_FRAGMENT = `
#include <clipping_planes_pars_fragment>
uniform vec3 uCap;
void main() {
  #include <clipping_planes_fragment>
  gl_FragColor = vec4(uCap, 1.0);
}`;

/** A material for the building: tints per vertex, light from the building's own sky and sun. */
export class SurfaceMaterial extends ShaderMaterial {
  constructor(planes: Plane[], opacity = 1) {
    super({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      vertexColors: true,
      clipping: true,
      clippingPlanes: planes,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      uniforms: {
        uSun: { value: new Vector3(0.45, -0.55, 0.75).normalize() },
        uEye: { value: new Vector3() },
        uOpacity: { value: opacity },
      },
    });
    this.setOpacity(opacity);
  }

  /** Where the viewer is, in the map's coordinates of the copy that wears the material. */
  get eye(): Vector3 {
    return this.uniforms.uEye.value as Vector3;
  }

  setOpacity(opacity: number): void {
    this.uniforms.uOpacity.value = opacity;
    this.transparent = opacity < 1;
    this.depthWrite = opacity >= 1;
  }
}

/**
 * A material for the caps where a building is cut: there one sees the back faces of solids, and nowhere else. They are a hair nearer
 * than they are, to cover a neighbour's face in the same plane: a slab's under the wall that it carries.
 */
export class CapMaterial extends ShaderMaterial {
  constructor(planes: Plane[]) {
    super({
      vertexShader: CAP_VERTEX,
      fragmentShader: CAP_FRAGMENT,
      side: BackSide,
      clipping: true,
      clippingPlanes: planes,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: -1,
      uniforms: { uCap: { value: new Color(CAP_COLOUR).convertLinearToSRGB() }, uNearer: { value: 0 } },
    });
  }

  /** Takes how far two faces of one plane may be apart after they came as whole numbers [m]. */
  setNearer(metres: number): void {
    this.uniforms.uNearer.value = metres;
  }
}
