// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { Color, DoubleSide, type Plane, ShaderMaterial, Vector3 } from "three";
import { CAP_COLOUR } from "./palette";

const VERTEX = `
#include <clipping_planes_pars_vertex>
attribute vec4 aKind;
varying vec3 vTint;
varying vec3 vMap;
varying float vSolid;
void main() {
  vTint = color;
  vMap = position;
  vSolid = aKind.x;
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * mvPosition;
  #include <clipping_planes_vertex>
}`;

// The slope of the map's coordinates over the picture gives a normal that faces the viewer: no normals are sent, and
// walls of one layer are lit from both sides. Back faces of solids are seen only where they are cut: these are the caps.
const FRAGMENT = `
#include <clipping_planes_pars_fragment>
uniform vec3 uCap;
uniform vec3 uSun;
uniform vec3 uEye;
uniform float uOpacity;
uniform float uCaps;
varying vec3 vTint;
varying vec3 vMap;
varying float vSolid;
void main() {
  #include <clipping_planes_fragment>
  if (!gl_FrontFacing && vSolid > 0.5 && uCaps > 0.5) {
    gl_FragColor = vec4(uCap, 1.0);
  } else {
    vec3 normal = normalize(cross(dFdx(vMap), dFdy(vMap)));
    float sky = normal.z * 0.5 + 0.5;
    float sun = max(dot(normal, uSun), 0.0);
    float facing = abs(dot(normal, normalize(uEye - vMap)));
    float side = abs(normal.x) * 0.06 - abs(normal.y) * 0.06;
    vec3 light = mix(vec3(0.56, 0.54, 0.53), vec3(0.76, 0.78, 0.82), sky);
    light += vec3(0.27, 0.255, 0.22) * sun + 0.10 * facing + side;
    // Undersides of slabs are what ceilings look like from below.
    vec3 tint = mix(vTint, vec3(0.93, 0.92, 0.9), 0.75 * clamp(-2.5 * normal.z - 1.25, 0.0, 1.0));
    gl_FragColor = vec4(tint * light, uOpacity);
  }
  #include <colorspace_fragment>
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
        uCap: { value: new Color(CAP_COLOUR) },
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
