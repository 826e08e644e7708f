// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BufferAttribute, BufferGeometry, Color, Mesh, MeshBasicMaterial } from "three";
import { GROUND_COLOUR, SKY_COLOUR } from "./palette";

/** After the building, before all that is seen through. */
const GROUND_ORDER = 6;
const SEGMENTS = 48;
/** Radii [m] of the rings; the outermost has the sky's colour, so that there is no horizon to be seen. */
const RADII = [0, 14, 60, 260];
const SKY_PART = [0, 0.12, 0.75, 1];

/** The ground around the building: one draw call, fading into the sky. Lies in the room's plane y = 0. */
export function makeGround(): Mesh<BufferGeometry, MeshBasicMaterial> {
  const positions: number[] = [];
  const colours: number[] = [];
  const indices: number[] = [];
  const [ground, sky] = [new Color(GROUND_COLOUR), new Color(SKY_COLOUR)];
  RADII.forEach((radius, ring) => {
    for (let s = 0; s < SEGMENTS; s++) {
      const angle = (2 * Math.PI * s) / SEGMENTS;
      positions.push(radius * Math.cos(angle), 0, -radius * Math.sin(angle));
      colours.push(...ground.clone().lerp(sky, SKY_PART[ring]).toArray());
      if (ring === 0) continue;
      const [a, b] = [(ring - 1) * SEGMENTS + s, (ring - 1) * SEGMENTS + ((s + 1) % SEGMENTS)];
      indices.push(a, a + SEGMENTS, b, b, a + SEGMENTS, b + SEGMENTS);
    }
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(positions), 3));
  geometry.setAttribute("color", new BufferAttribute(Float32Array.from(colours), 3));
  geometry.setIndex(indices);
  const mesh = new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true }));
  // Behind all that is solid: what is covered is not painted first.
  mesh.renderOrder = GROUND_ORDER;
  return mesh;
}
