// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BufferGeometry, CapsuleGeometry, ConeGeometry, Mesh, MeshLambertMaterial, SphereGeometry } from "three";
import { type Vector3 } from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";

/** From nearer than this, aside and in height, the figure is no figure but a red haze before the eyes [m]. */
const NEAR_M = 0.8;
const NEAR_HEIGHT_M = 2;

/** Whether an eye in the room is in, or right beside, the figure at full scale whose own eye is here in the map. */
export function fillsView(figure: ArrayLike<number>, eye: Vector3): boolean {
  const aside = Math.hypot(figure[0] - eye.x, figure[1] + eye.z);
  return aside < NEAR_M && Math.abs(figure[2] - eye.y) < NEAR_HEIGHT_M;
}

/** The figure that runs along the tour: feet at its origin, looking along +x, as tall as a walker [m]. */
export function makeWalker(eyeHeightM: number): Mesh<BufferGeometry, MeshLambertMaterial> {
  const height = eyeHeightM + 0.12;
  const body = new CapsuleGeometry(0.19, height - 0.85, 3, 10).rotateX(Math.PI / 2).translate(0, 0, (height - 0.3) / 2);
  const head = new SphereGeometry(0.15, 12, 8).translate(0, 0, eyeHeightM);
  const nose = new ConeGeometry(0.06, 0.18, 6).rotateZ(-Math.PI / 2).translate(0.2, 0, eyeHeightM);
  const figure = mergeGeometries([body, head, nose].map((part) => part.toNonIndexed()));
  const mesh = new Mesh(figure, new MeshLambertMaterial({ color: "#d6336c" }));
  mesh.visible = false;
  return mesh;
}
