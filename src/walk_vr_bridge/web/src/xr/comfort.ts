// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BackSide, Mesh, ShaderMaterial, SphereGeometry } from "three";

/** How fast vignette and fade come and go [1/s]. */
const VIGNETTE_RATE = 4;
const FADE_RATE = 5;

/** A dome around the head that darkens the rim of sight while one is moved, and all of it for a moment at jumps. */
export class Comfort {
  readonly mesh: Mesh<SphereGeometry, ShaderMaterial>;
  vignette = 0;
  fade = 0;
  private wanted = 0;

  constructor() {
    const material = new ShaderMaterial({
      side: BackSide,
      transparent: true,
      depthTest: false,
      depthWrite: false,
      uniforms: { uVignette: { value: 0 }, uFade: { value: 0 } },
      vertexShader: `
varying vec3 vAt;
void main() {
  vAt = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`,
      fragmentShader: `
uniform float uVignette;
uniform float uFade;
varying vec3 vAt;
void main() {
  float angle = acos(clamp(-normalize(vAt).z, -1.0, 1.0));
  float rim = smoothstep(mix(1.2, 0.42, uVignette), mix(1.4, 0.72, uVignette), angle);
  gl_FragColor = vec4(0.03, 0.04, 0.05, max(rim * uVignette, uFade));
}`,
    });
    this.mesh = new Mesh(new SphereGeometry(2, 24, 16), material);
    this.mesh.renderOrder = 1000;
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  /** What the speed of the rig asks for, 0 to 1. */
  narrow(strength: number): void {
    this.wanted = strength;
  }

  /** Darkens at once; clears by itself. */
  blink(): void {
    this.fade = 1;
  }

  update(seconds: number): void {
    const step = Math.min(1, VIGNETTE_RATE * seconds);
    this.vignette += (this.wanted - this.vignette) * step;
    this.fade = Math.max(0, this.fade - FADE_RATE * seconds);
    this.mesh.visible = this.vignette > 0.02 || this.fade > 0.01;
    this.mesh.material.uniforms.uVignette.value = this.vignette;
    this.mesh.material.uniforms.uFade.value = this.fade;
  }
}

/** How much of the rim is darkened at a speed [m/s] and a turn [rad/s]: nothing at rest, all of it when running. */
export function vignetteFor(speed: number, turnRate: number): number {
  return Math.min(1, Math.max(0, Math.abs(speed) / 2 + Math.abs(turnRate) / 1.5));
}
