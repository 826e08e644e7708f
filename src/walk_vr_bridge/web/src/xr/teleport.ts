// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Group, Line, LineBasicMaterial, Mesh } from "three";
import { MeshBasicMaterial, RingGeometry, Vector3 } from "three";
import type { Stage } from "../scene/stage";
import type { HandInput } from "./input";

const STEPS = 40;
const STEP_S = 0.05;
const SPEED_MPS = 7;
const GRAVITY = 9.81;
/** Floors are flatter than this. */
const FLAT = 0.7;

/** Where a hand points to go: a thrown arc at full scale, a straight ray into the miniature. */
export class Teleport {
  readonly group = new Group();
  /** The floor pointed at, in the map; only while `valid`. */
  readonly target = new Vector3();
  valid = false;
  /** Whether the target was found in the miniature. */
  inMiniature = false;
  active = false;
  private readonly line: Line<BufferGeometry, LineBasicMaterial>;
  private readonly ring: Mesh<RingGeometry, MeshBasicMaterial>;
  private readonly points = new BufferAttribute(new Float32Array((STEPS + 1) * 3), 3);

  constructor(private readonly stage: Stage) {
    const geometry = new BufferGeometry();
    this.points.setUsage(DynamicDrawUsage);
    geometry.setAttribute("position", this.points);
    this.line = new Line(geometry, new LineBasicMaterial({ color: "#1f8fff" }));
    const look = new MeshBasicMaterial({ color: "#1f8fff", transparent: true, opacity: 0.85, depthTest: false });
    this.ring = new Mesh(new RingGeometry(0.7, 1, 32).rotateX(-Math.PI / 2), look);
    this.ring.renderOrder = 45;
    this.line.frustumCulled = false;
    this.group.add(this.line, this.ring);
    this.group.visible = false;
  }

  aim(hand: HandInput): void {
    this.active = true;
    this.group.visible = true;
    this.valid = this.aimAtMiniature(hand);
    this.inMiniature = this.valid;
    if (!this.valid) this.valid = this.throwArc(hand);
    this.line.material.color.set(this.valid ? "#1f8fff" : "#b4474c");
    this.ring.visible = this.valid;
    if (!this.valid) return;
    const { place } = this.inMiniature ? this.stage.inMiniature : this.stage.inFull;
    place.toRoom(this.target, this.ring.position);
    this.ring.position.y += 0.01 * place.scale;
    this.ring.scale.setScalar(this.inMiniature ? Math.max(0.012, 0.35 * place.scale) : 0.35);
  }

  stop(): void {
    this.active = this.valid = false;
    this.group.visible = false;
  }

  private aimAtMiniature(hand: HandInput): boolean {
    const { stage } = this;
    const bvh = stage.models?.bvh;
    if (!bvh || !stage.miniature.group.visible) return false;
    const { origin, direction } = stage.inMiniature.place.rayToMap(hand.ray);
    const { clip } = stage.miniature;
    const skip = clip.active ? entry(clip.plane, origin, direction) : 0;
    const hit = bvh.cast(origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, skip);
    if (hit.distance === Infinity || hit.nz < FLAT) return false;
    this.target.copy(origin).addScaledVector(direction, hit.distance);
    const end = stage.inMiniature.place.toRoom(this.target, END);
    for (let i = 0; i <= STEPS; i++) this.setPoint(i, AT.copy(hand.ray.origin).lerp(end, i / STEPS));
    this.drawLine(STEPS + 1);
    return true;
  }

  private throwArc(hand: HandInput): boolean {
    const bvh = this.stage.models?.bvh;
    const { world } = this.stage;
    AT.copy(hand.ray.origin);
    FLY.copy(hand.ray.direction).multiplyScalar(SPEED_MPS);
    this.setPoint(0, AT);
    for (let i = 1; i <= STEPS; i++) {
      NEXT.copy(AT).addScaledVector(FLY, STEP_S);
      FLY.y -= GRAVITY * STEP_S;
      const hit = bvh ? this.segment(world.worldToLocal(FROM.copy(AT)), world.worldToLocal(TO.copy(NEXT))) : null;
      if (hit) {
        this.target.copy(hit);
        this.setPoint(i, world.localToWorld(END.copy(hit)));
        this.drawLine(i + 1);
        return bvh !== undefined && bvh.hit.nz > FLAT;
      }
      this.setPoint(i, AT.copy(NEXT));
    }
    this.drawLine(STEPS + 1);
    return false;
  }

  private segment(from: Vector3, to: Vector3): Vector3 | null {
    const bvh = this.stage.models?.bvh;
    const length = from.distanceTo(to);
    TO.subVectors(to, from).divideScalar(length || 1);
    if (!bvh || bvh.cast(from.x, from.y, from.z, TO.x, TO.y, TO.z, 0, length).distance === Infinity) return null;
    return FROM.addScaledVector(TO, bvh.hit.distance);
  }

  private setPoint(index: number, at: Vector3): void {
    this.points.setXYZ(index, at.x, at.y, at.z);
  }

  private drawLine(count: number): void {
    this.line.geometry.setDrawRange(0, count);
    this.points.needsUpdate = true;
  }
}

/** How far along a ray it comes to the kept side of a plane; 0 where it starts there. */
export function entry(plane: { normal: Vector3; constant: number }, origin: Vector3, direction: Vector3): number {
  const side = plane.normal.dot(origin) + plane.constant;
  const rate = plane.normal.dot(direction);
  if (side >= 0) return 0;
  return rate > 1e-9 ? -side / rate : Infinity;
}

const AT = new Vector3();
const NEXT = new Vector3();
const FLY = new Vector3();
const FROM = new Vector3();
const TO = new Vector3();
const END = new Vector3();
