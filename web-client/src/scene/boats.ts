// The boats: one mesh per boat, made when the boat appears, disposed when it is removed, and placed in every frame.
import { Mesh, Scene, type BufferGeometry, type RawShaderMaterial } from "three";

import type { BoatDetail } from "../codec/greeting";
import { mixBodies, type BodiesState, type BodyPose } from "./bodies";
import { makeBoatGeometry } from "./boat_mesh";

export class Boats {
  private readonly meshes = new Map<number, Mesh<BufferGeometry, RawShaderMaterial>>();
  private readonly poses: BodyPose[] = [];
  private posesCount = 0;

  /** `material` is shared; the caller disposes it. */
  constructor(
    private readonly scene: Scene,
    private readonly material: RawShaderMaterial,
  ) {}

  /** Sets the boats on the water; known boats keep their meshes. */
  setBoats(boats: readonly BoatDetail[]): void {
    const there = new Set(boats.map(({ boatId }) => boatId));
    for (const [boatId, mesh] of this.meshes) if (!there.has(boatId)) this.drop(boatId, mesh);
    for (const boat of boats) {
      if (this.meshes.has(boat.boatId)) continue;
      const mesh = new Mesh(makeBoatGeometry(boat), this.material);
      // Pitch (bow up) turns about z, roll (starboard down) about x. Headings turn from +x toward +z, opposite to three's y rotation.
      mesh.rotation.order = "YZX";
      mesh.visible = false;
      this.meshes.set(boat.boatId, mesh);
      this.scene.add(mesh);
    }
  }

  show(from: BodiesState, to: BodiesState, mix: number): void {
    this.posesCount = mixBodies(from, to, mix, this.poses);
    for (const mesh of this.meshes.values()) mesh.visible = false;
    for (let i = 0; i < this.posesCount; ++i) {
      const pose = this.poses[i]!;
      const mesh = this.meshes.get(pose.boatId);
      if (!mesh) continue;
      mesh.visible = true;
      mesh.position.set(pose.xM, pose.yM, pose.zM);
      mesh.rotation.set(pose.rollRad, -pose.headingRad, pose.pitchRad, "YZX");
    }
  }

  /** Returns the pose in which a boat is drawn now. The next frame overwrites it. */
  poseOf(boatId: number): BodyPose | undefined {
    for (let i = 0; i < this.posesCount; ++i) if (this.poses[i]!.boatId === boatId) return this.poses[i];
    return undefined;
  }

  /** Returns copies of all poses drawn now. */
  drawn(): BodyPose[] {
    return this.poses.slice(0, this.posesCount).map((pose) => ({ ...pose }));
  }

  dispose(): void {
    for (const [boatId, mesh] of this.meshes) this.drop(boatId, mesh);
  }

  private drop(boatId: number, mesh: Mesh<BufferGeometry, RawShaderMaterial>): void {
    this.scene.remove(mesh);
    mesh.geometry.dispose();
    this.meshes.delete(boatId);
  }
}
