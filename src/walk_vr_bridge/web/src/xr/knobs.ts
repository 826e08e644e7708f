// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BufferAttribute, BufferGeometry, CylinderGeometry, Group, LineBasicMaterial, LineLoop, Mesh } from "three";
import { MeshLambertMaterial, Quaternion, SphereGeometry, Vector3 } from "three";
import type { Stage } from "../scene/stage";
import type { HandInput } from "./input";

/** In the room [m]. */
const KNOB_M = 0.016;
const REACH_M = 0.06;
/** A knob that a hand is at is so much larger. */
const GROWN = 1.35;

/** `level` moves the cut up and down and snaps to storeys; `free` holds it like a sheet of paper. */
export type KnobName = "level" | "free";

/** The two knobs that move the miniature's cut, and the frame that shows where it is. */
export class Knobs {
  readonly group = new Group();
  hover: KnobName | null = null;
  private readonly level = new Mesh(new CylinderGeometry(1, 1, 1.5, 20).rotateX(Math.PI / 2), look("#2f7de1"));
  private readonly free = new Mesh(new SphereGeometry(1, 16, 12), look("#8a5cf0"));
  private readonly frame = new LineLoop(new BufferGeometry(), new LineBasicMaterial({ color: "#2f7de1" }));
  private readonly corners = new BufferAttribute(new Float32Array(12), 3);
  private readonly normal = new Vector3();
  private readonly turn = new Quaternion();
  private lift = 0;
  private seen = -1;

  constructor(private readonly stage: Stage) {
    this.frame.geometry.setAttribute("position", this.corners);
    this.frame.frustumCulled = false;
    this.group.add(this.level, this.free, this.frame);
    stage.miniature.group.add(this.group);
  }

  /** The knob within a hand's reach, else the one its ray meets; null: none. */
  at(hand: HandInput): KnobName | null {
    for (let i = 0; i < NAMES.length; i++) {
      const name = NAMES[i];
      this.mesh(name).getWorldPosition(AT);
      if (AT.distanceTo(hand.tip) < REACH_M) return name;
      AT.sub(hand.ray.origin);
      const along = AT.dot(hand.ray.direction);
      if (along <= 0 || along > 4) continue;
      const aside = Math.sqrt(Math.max(0, AT.lengthSq() - along * along));
      if (aside < Math.max(KNOB_M, along * 0.03)) return name;
    }
    return null;
  }

  take(hand: HandInput, name: KnobName): void {
    const { place } = this.stage.inMiniature;
    this.lift = this.mesh(name).position.z - place.toMap(hand.anchor, AT).z;
    this.normal.copy(this.stage.miniature.clip.plane.normal).negate();
    this.turn.copy(hand.turn).invert();
  }

  /** Moves the cut with the hand. Returns true where it has just snapped to another storey. */
  follow(hand: HandInput, name: KnobName): boolean {
    const { clip } = this.stage.miniature;
    const { place } = this.stage.inMiniature;
    const before = clip.storey;
    if (name === "level") {
      clip.cutAt(place.toMap(hand.anchor, AT).z + this.lift, true);
      return clip.storey !== before && clip.storey >= 0;
    }
    // The hand's turn since it took hold, brought from the room into the map.
    this.stage.miniature.group.getWorldQuaternion(ROOM);
    TURN.copy(ROOM).invert().multiply(hand.turn).multiply(this.turn).multiply(ROOM);
    NORMAL.copy(this.normal).applyQuaternion(TURN).normalize();
    clip.cutAlong(NORMAL, place.toMap(hand.anchor, AT));
    return false;
  }

  /** Once a frame: to where the cut is; of one size in the room, whatever the miniature's is. */
  update(): void {
    const { miniature, bounds } = this.stage;
    const size = KNOB_M / this.stage.inMiniature.place.scale;
    this.level.scale.setScalar(this.hover === "level" ? GROWN * size : size);
    this.free.scale.setScalar(this.hover === "free" ? GROWN * size : size);
    if (this.seen === miniature.clip.version && this.corners.getX(0) === bounds.min.x) return;
    this.seen = miniature.clip.version;
    this.layFrame(size);
  }

  private layFrame(size: number): void {
    const { clip } = this.stage.miniature;
    const { min, max } = this.stage.bounds;
    const height = (x: number, y: number): number => Math.min(max.z + 1, Math.max(min.z - 1, clip.heightAt(x, y)));
    this.corners.setXYZ(0, min.x, min.y, height(min.x, min.y));
    this.corners.setXYZ(1, max.x, min.y, height(max.x, min.y));
    this.corners.setXYZ(2, max.x, max.y, height(max.x, max.y));
    this.corners.setXYZ(3, min.x, max.y, height(min.x, max.y));
    this.corners.needsUpdate = true;
    const out = 2.2 * size;
    this.level.position.set(max.x + out, min.y, height(max.x, min.y));
    this.free.position.set(max.x + out, max.y, height(max.x, max.y));
  }

  private mesh(name: KnobName): Mesh {
    return name === "level" ? this.level : this.free;
  }
}

const NAMES: readonly KnobName[] = ["level", "free"];
const AT = new Vector3();
const NORMAL = new Vector3();
const ROOM = new Quaternion();
const TURN = new Quaternion();

function look(colour: string): MeshLambertMaterial {
  return new MeshLambertMaterial({ color: colour });
}
