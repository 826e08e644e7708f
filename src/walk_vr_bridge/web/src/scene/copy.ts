// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BufferGeometry, Group, LineBasicMaterial, LineSegments, Mesh, type Plane, Vector3 } from "three";
import type { BuildingModel } from "./model";
import { EDGE_COLOUR } from "./palette";
import { CapMaterial, SurfaceMaterial } from "./surface";

const GLASS_OPACITY = 0.28;
const THIN_OPACITY = 0.16;
/** A pane has two faces and often a frame around it: seen through walls it must not be what is most solid. */
const THIN_GLASS_OPACITY = 0.08;

/** Positions come as whole numbers of so many bits: each is off by up to half of one, see docs/protocol.md. */
const WHOLE = 2 ** 16;
const STEPS = 1.5;

/** One showing of the building: full scale, or the miniature, which is cut by planes of its own. */
export class BuildingCopy {
  readonly group = new Group();
  private readonly solid: Mesh<BufferGeometry, SurfaceMaterial>;
  private readonly glass: Mesh<BufferGeometry, SurfaceMaterial>;
  private readonly caps: readonly [Mesh<BufferGeometry, CapMaterial>, Mesh<BufferGeometry, CapMaterial>];
  private readonly edges: LineSegments<BufferGeometry, LineBasicMaterial>;
  private readonly eye = new Vector3();

  constructor(planes: Plane[]) {
    this.solid = new Mesh(new BufferGeometry(), new SurfaceMaterial(planes));
    this.glass = new Mesh(new BufferGeometry(), new SurfaceMaterial(planes, GLASS_OPACITY));
    const cap = new CapMaterial(planes);
    this.caps = [new Mesh(new BufferGeometry(), cap), new Mesh(new BufferGeometry(), cap)];
    const ink = new LineBasicMaterial({ color: EDGE_COLOUR, transparent: true, opacity: 0.55, clippingPlanes: planes });
    this.edges = new LineSegments(new BufferGeometry(), ink);
    this.glass.renderOrder = 20;
    this.edges.renderOrder = 10;
    this.group.add(this.solid, ...this.caps, this.edges, this.glass);
    this.showCaps(false);
  }

  setModel(model: BuildingModel): void {
    this.solid.geometry = model.surface;
    this.glass.geometry = model.glass;
    this.glass.visible = (model.glass.index?.count ?? 0) > 0;
    this.caps[0].geometry = model.surface;
    this.caps[1].geometry = model.glass;
    model.bounds.getSize(this.eye);
    this.caps[0].material.setNearer((STEPS * Math.max(this.eye.x, this.eye.y, this.eye.z)) / WHOLE);
    this.edges.geometry = model.edges;
  }

  /** Lets one look through the walls. */
  setThin(thin: boolean): void {
    this.solid.material.setOpacity(thin ? THIN_OPACITY : 1);
    this.glass.material.setOpacity(thin ? THIN_GLASS_OPACITY : GLASS_OPACITY);
    this.solid.renderOrder = thin ? 15 : 0;
  }

  /** Fills what is cut; not where one looks through the walls, and sees their back faces everywhere. */
  showCaps(visible: boolean): void {
    this.caps[0].visible = visible;
    this.caps[1].visible = visible && this.glass.visible;
  }

  setEdgeStrength(opacity: number): void {
    this.edges.material.opacity = opacity;
    this.edges.visible = opacity > 0.02;
  }

  /** Tells the light where the viewer is, in world coordinates. */
  lookFrom(viewer: Vector3): void {
    this.eye.copy(viewer);
    this.group.worldToLocal(this.eye);
    this.solid.material.eye.copy(this.eye);
    this.glass.material.eye.copy(this.eye);
  }
}
