// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0

import { BoxGeometry, BufferGeometry, CapsuleGeometry, type Group, InstancedMesh, Matrix4, Mesh } from "three";
import { MeshBasicMaterial, MeshLambertMaterial, SphereGeometry, TorusGeometry, Vector3, type XRHandSpace } from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { HandInput } from "./input";

const JOINTS = 25;
const FAINT_M = 0.45;

/** What one sees of a hand: a plain controller or the joints of a bare hand, and the ray. Nothing is fetched. */
export class HandLook {
  private readonly body: Mesh;
  private readonly joints: InstancedMesh;
  private readonly ray: Mesh<BoxGeometry, MeshBasicMaterial>;
  private jointSpace: XRHandSpace | null = null;

  constructor(private readonly hand: HandInput) {
    const skin = new MeshLambertMaterial({ color: hand.side === "left" ? "#3d4b5a" : "#46566a" });
    this.body = new Mesh(controllerShape(), skin);
    this.joints = new InstancedMesh(new SphereGeometry(1, 8, 6), new MeshLambertMaterial({ color: "#d8b49a" }), JOINTS);
    this.joints.frustumCulled = false;
    const beam = new MeshBasicMaterial({ color: "#1f8fff", transparent: true, opacity: 0.6, depthWrite: false });
    this.ray = new Mesh(new BoxGeometry(0.003, 0.003, 1).translate(0, 0, -0.5), beam);
  }

  /** Hangs it on the groups that follow the source. */
  wear(target: Group, grip: Group, joints: XRHandSpace): void {
    target.add(this.ray);
    this.jointSpace = joints;
    if (this.hand.bare) {
      this.body.removeFromParent();
      joints.parent?.add(this.joints);
    } else {
      this.joints.removeFromParent();
      grip.add(this.body);
    }
  }

  /** Once a frame. @param reach how far the ray goes [m]; 0: it is not shown. */
  update(reach: number, lit: boolean): void {
    this.ray.visible = reach > 0 && this.hand.tracked;
    this.ray.scale.z = Math.min(reach, lit ? reach : FAINT_M);
    this.ray.material.opacity = lit ? 0.85 : 0.3;
    if (this.hand.bare) this.placeJoints();
  }

  private placeJoints(): void {
    const space = this.jointSpace;
    if (!space) return;
    let count = 0;
    for (const name in space.joints) {
      const joint = space.joints[name as XRHandJoint];
      if (!joint?.visible || count >= JOINTS) continue;
      const radius = joint.jointRadius ?? 0.008;
      this.joints.setMatrixAt(count++, PLACE.copy(joint.matrix).scale(SIZE.setScalar(radius)));
    }
    this.joints.count = count;
    this.joints.instanceMatrix.needsUpdate = true;
  }
}

function controllerShape(): BufferGeometry {
  const handle = new CapsuleGeometry(0.017, 0.075, 4, 12).rotateX(Math.PI / 2).translate(0, -0.008, 0.03);
  const head = new SphereGeometry(0.026, 14, 10).scale(1, 0.62, 1.15).translate(0, 0.004, -0.028);
  const stick = new CapsuleGeometry(0.006, 0.006, 3, 8).translate(-0.008, 0.024, -0.024);
  const button = new SphereGeometry(0.0055, 8, 6).translate(0.01, 0.019, -0.018);
  const trigger = new BoxGeometry(0.012, 0.02, 0.012).translate(0, -0.014, -0.045);
  const rim = new TorusGeometry(0.03, 0.003, 6, 20).rotateX(Math.PI / 2).translate(0, 0.004, -0.028);
  return mergeGeometries([handle, head, stick, button, trigger, rim].map((part) => part.toNonIndexed()));
}

const PLACE = new Matrix4();

const SIZE = new Vector3();
