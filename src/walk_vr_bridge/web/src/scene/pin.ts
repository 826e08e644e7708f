// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

/** The shape of a keypoint: a ball at the eye, a nose that looks ahead (+x), a stem and a foot on the floor. */

import { BufferAttribute, BufferGeometry, ConeGeometry, CylinderGeometry, IcosahedronGeometry } from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";

/** Returns the shape for a ball of radius 1; `aDrop` is 1 for what stands on the floor. */
export function makePin(): BufferGeometry {
  const ball = new IcosahedronGeometry(1, 1);
  const nose = new ConeGeometry(0.62, 1.1, 8, 1, true).rotateZ(-Math.PI / 2).translate(1.25, 0, 0);
  const stem = new CylinderGeometry(0.11, 0.11, 1, 5, 1, true).rotateX(Math.PI / 2);
  const foot = new CylinderGeometry(0.75, 0.75, 0.06, 10, 1).rotateX(Math.PI / 2);
  const parts = [ball, nose, stem, foot].map((part) => (part.index ? part.toNonIndexed() : part));
  const [, , post, disc] = parts;
  const drops = parts.map((part) => new Float32Array(part.getAttribute("position").count));
  const places = post.getAttribute("position");
  for (let v = 0; v < places.count; v++) {
    drops[2][v] = places.getZ(v) < 0 ? 1 : 0;
    places.setZ(v, 0);
  }
  drops[3].fill(1);
  disc.translate(0, 0, 0.03);
  parts.forEach((part, i) => {
    part.deleteAttribute("uv");
    part.setAttribute("aDrop", new BufferAttribute(drops[i], 1));
  });
  return mergeGeometries(parts);
}
