// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Color, DoubleSide, type Plane, ShaderMaterial, Vector3 } from "three";
import { CAP_COLOUR } from "./palette";

// All but the angle at which one looks at a triangle holds for the whole of it: its two colours, looked at along it and straight
// at it, stand at its last vertex (see facets.ts), as do the distance of its plane from the eye and whether it encloses anything.
const VERTEX = `
#include <clipping_planes_pars_vertex>
#include <colorspace_pars_fragment>
attribute vec4 aKind;
uniform vec3 uSun;
uniform vec3 uEye;
flat varying vec4 vAlong;
flat varying vec4 vStraight;
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
  vStraight = vec4(shown(tint * (light + 0.10)), aKind.w);
  vFromEye = position - uEye;
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * mvPosition;
  #include <clipping_planes_vertex>
}`;

// Back faces of solids are seen only where they are cut: these are the caps.
const FRAGMENT = `
#include <clipping_planes_pars_fragment>
uniform vec3 uCap;
uniform float uOpacity;
uniform float uCaps;
flat varying vec4 vAlong;
flat varying vec4 vStraight;
varying vec3 vFromEye;
void main() {
  #include <clipping_planes_fragment>
  float facing = min(vAlong.w * inversesqrt(dot(vFromEye, vFromEye)), 1.0);
  vec4 lit = vec4(mix(vAlong.rgb, vStraight.rgb, facing), uOpacity);
  gl_FragColor = !gl_FrontFacing && vStraight.w * uCaps > 0.5 ? vec4(uCap, 1.0) : lit;
}`;

/** A material for the building: tints per vertex, light from the building's own sky and sun, caps where it is cut. */
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
        uCap: { value: new Color(CAP_COLOUR).convertLinearToSRGB() },
        uSun: { value: new Vector3(0.45, -0.55, 0.75).normalize() },
        uEye: { value: new Vector3() },
        uOpacity: { value: opacity },
        uCaps: { value: 1 },
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
