// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BufferGeometry, type Data3DTexture, Group, Mesh, type Plane, PlaneGeometry, Points } from "three";
import { DoubleSide, GLSL3, Matrix4, Quaternion, ShaderMaterial, Vector2, Vector3 } from "three";
import type { ChannelName, ImportanceState } from "../client/state";
import { OVER_FLOOR_M } from "./carpet";
import { CUT_OVER_FLOOR_M } from "./clipping";
import { SCALE_GLSL } from "./colourmap";
import { channelIndex } from "./volume";

const LAID_VERTEX = `
#include <clipping_planes_pars_vertex>
out vec3 vMap;
uniform mat4 uPlace;
void main() {
  vec4 place = uPlace * vec4(position, 1.0);
  vMap = place.xyz;
  vec4 mvPosition = modelViewMatrix * place;
  gl_Position = projectionMatrix * mvPosition;
  #include <clipping_planes_vertex>
}`;
const LAID_FRAGMENT = `
#include <clipping_planes_pars_fragment>
precision highp sampler3D;
uniform sampler3D uVolume;
uniform vec3 uOrigin;
uniform vec3 uSize;
uniform vec4 uChannel;
uniform vec4 uFull;
uniform float uSolid;
uniform float uLift;
uniform vec2 uRange;
in vec3 vMap;
out vec4 colour;
${SCALE_GLSL}
void main() {
  #include <clipping_planes_fragment>
  vec3 at = (vMap + vec3(0.0, 0.0, uLift) - uOrigin) / uSize;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) discard;
  vec4 voxel = texture(uVolume, at);
  float full = dot(voxel, uFull);
  if (uSolid > 0.5 ? full < 0.5 : full > 0.5) discard;
  colour = uSolid > 0.5 ? vec4(0.72, 0.2, 0.17, 0.9) : vec4(scaleColour((dot(voxel, uChannel) - uRange.x) / uRange.y), 0.86);
}`;
const POINT_VERTEX = `
#include <clipping_planes_pars_vertex>
attribute float aValue;
uniform float uPixels;
out float vValue;
void main() {
  vValue = aValue;
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * mvPosition;
  gl_PointSize = clamp(uPixels / -mvPosition.z, 1.5, 14.0);
  #include <clipping_planes_vertex>
}`;
const POINT_FRAGMENT = `
#include <clipping_planes_pars_fragment>
uniform float uSolid;
uniform vec2 uRange;
in float vValue;
out vec4 colour;
${SCALE_GLSL}
void main() {
  #include <clipping_planes_fragment>
  vec2 off = gl_PointCoord - 0.5;
  if (dot(off, off) > 0.25) discard;
  colour = vec4(uSolid > 0.5 ? vec3(0.72, 0.2, 0.17) : scaleColour((vValue - uRange.x) / uRange.y), 0.8);
}`;

/** One map of the building: as a slice along a plane, laid on the floors, and as points. */
export class MapView {
  readonly group = new Group();
  private readonly slice: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly carpet: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly points: Points<BufferGeometry, ShaderMaterial>;

  constructor(planes: Plane[]) {
    const solid = { value: 0 };
    const range = { value: new Vector2(0, 1) };
    const laid = {
      uVolume: { value: null },
      uOrigin: { value: new Vector3() },
      uSize: { value: new Vector3(1, 1, 1) },
      uChannel: { value: [0, 0, 0, 1] },
      uFull: { value: [1, 0, 0, 0] },
      uSolid: solid,
      uRange: range,
    };
    const slice = laidMaterial([], { ...laid, uLift: { value: 0 }, uPlace: { value: new Matrix4() } });
    const carpet = laidMaterial(planes, {
      ...laid,
      uLift: { value: CUT_OVER_FLOOR_M - OVER_FLOOR_M },
      uPlace: { value: new Matrix4() },
    });
    const dots = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: POINT_VERTEX,
      fragmentShader: POINT_FRAGMENT,
      clipping: planes.length > 0,
      clippingPlanes: planes,
      transparent: true,
      depthWrite: false,
      uniforms: { uSolid: solid, uRange: range, uPixels: { value: 20 } },
    });
    this.slice = new Mesh(new PlaneGeometry(1, 1), slice);
    this.points = new Points(new BufferGeometry(), dots);
    this.carpet = new Mesh(new BufferGeometry(), carpet);
    this.slice.frustumCulled = this.carpet.frustumCulled = this.points.frustumCulled = false;
    this.slice.renderOrder = this.carpet.renderOrder = 12;
    this.points.renderOrder = 14;
    this.group.add(this.slice, this.carpet, this.points);
    this.group.visible = false;
  }

  /** Shows one channel of the map: its texture along the slice and on the floors, its points. */
  show(
    map: ImportanceState,
    channel: ChannelName,
    texture: Data3DTexture,
    points: BufferGeometry,
    floors: BufferGeometry,
    range: readonly [number, number],
  ): void {
    const { uniforms } = this.slice.material;
    uniforms.uVolume.value = texture;
    uniforms.uOrigin.value.fromArray(map.origin);
    uniforms.uSize.value.fromArray(map.shape).multiplyScalar(map.voxelM);
    uniforms.uRange.value.set(range[0], Math.max(1e-3, range[1] - range[0]));
    uniforms.uSolid.value = channel === "obstacle" ? 1 : 0;
    mask(uniforms.uChannel.value as number[], channelIndex(map, channel));
    mask(uniforms.uFull.value as number[], channelIndex(map, "obstacle"));
    this.points.geometry = points;
    this.carpet.geometry = floors;
    this.group.visible = true;
  }

  hide(): void {
    this.group.visible = false;
  }

  /** Shows the map on the floors, as it is at a cut above them. */
  showCarpet(visible: boolean): void {
    this.carpet.visible = visible;
  }

  showPoints(visible: boolean): void {
    this.points.visible = visible;
  }

  setPointSize(pixelsAtOneMetre: number): void {
    this.points.material.uniforms.uPixels.value = pixelsAtOneMetre;
  }

  /**
   * Lays the slice along the plane (its normal points to what is kept), around the middle, as wide as needed [m].
   *
   * @param liftM how far over the slice the map is read: a slice on the floor shows what is at a cut above it.
   */
  setSlice(plane: Plane | null, middle: Vector3, width: number, liftM: number): void {
    this.slice.visible = plane !== null;
    this.slice.material.uniforms.uLift.value = liftM;
    if (!plane) return;
    plane.projectPoint(middle, AT);
    // A hair on the kept side: the cap and the slice must not fight for one depth.
    AT.addScaledVector(plane.normal, -0.01);
    TURN.setFromUnitVectors(AHEAD, NORMAL.copy(plane.normal).negate());
    this.slice.material.uniforms.uPlace.value.compose(AT, TURN, SIZE.set(width, width, 1));
  }
}

function laidMaterial(planes: Plane[], uniforms: ShaderMaterial["uniforms"]): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: LAID_VERTEX,
    fragmentShader: LAID_FRAGMENT,
    side: DoubleSide,
    clipping: planes.length > 0,
    clippingPlanes: planes,
    transparent: true,
    depthWrite: false,
    uniforms,
  });
}

function mask(values: number[], index: number): void {
  for (let c = 0; c < values.length; c++) values[c] = c === index ? 1 : 0;
}

const AHEAD = new Vector3(0, 0, 1);
const AT = new Vector3();
const NORMAL = new Vector3();
const TURN = new Quaternion();
const SIZE = new Vector3();
