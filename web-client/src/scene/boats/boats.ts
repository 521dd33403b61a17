// The boats: made when they appear or get another owner, disposed when they are removed, placed in every frame. Each has a mesh and a lid:
// a surface at its gunwale that has a depth but no colour. It is drawn after all solids, so that the water inside the hull, which is
// behind it, is not drawn.
import { Group, Mesh, Scene, type BufferGeometry, type RawShaderMaterial, type Vector3 } from "three";

import type { BoatDetail } from "../../../client/codec/greeting";
import type { BodyPose } from "../../../client/codec/bodies";
import { mixBodies, type BodiesState } from "../frames/bodies";
import type { Lamps } from "../light/lamps";
import { castsShadow } from "../meshes/casters";
import { makeBoatParts } from "./boat_geometry";
import { addBoatLamps } from "./boat_lamps";
import type { HullPlan } from "./buoys";
import type { BoatLamp } from "./fittings";
import { sunkM } from "./lines";
import type { BoatColors } from "./livery";

/** A boat as it is drawn. */
interface DrawnBoat {
  detail: BoatDetail;
  colors: BoatColors | undefined;
  group: Group;
  geometries: BufferGeometry[];
  lamps: BoatLamp[];
}

export class Boats {
  private readonly boats = new Map<number, DrawnBoat>();
  private readonly poses: BodyPose[] = [];
  private posesCount = 0;
  private ownerColors: ReadonlyMap<number, BoatColors> = new Map();

  /** The caller disposes the materials; `lidMaterial` writes no colour. */
  constructor(
    private readonly scene: Scene,
    private readonly material: RawShaderMaterial,
    private readonly lidMaterial: RawShaderMaterial,
    private readonly plain: boolean,
  ) {}

  /** Sets the boats on the water; known boats keep their meshes. */
  setBoats(boats: readonly BoatDetail[]): void {
    const there = new Set(boats.map(({ boatId }) => boatId));
    for (const boatId of [...this.boats.keys()]) if (!there.has(boatId)) this.drop(boatId);
    for (const boat of boats) if (!this.boats.has(boat.boatId)) this.build(boat);
  }

  /** Paints the boats in the colours of their owners and teams, by boat; the others in one of their own. */
  setOwnerColors(colors: ReadonlyMap<number, BoatColors>): void {
    this.ownerColors = colors;
    for (const { detail, colors: before } of [...this.boats.values()]) {
      const now = colors.get(detail.boatId);
      if (before?.owner === now?.owner && before?.team === now?.team) continue;
      this.drop(detail.boatId);
      this.build(detail);
    }
  }

  show(from: BodiesState, to: BodiesState, mix: number): void {
    this.posesCount = mixBodies(from, to, mix, this.poses);
    for (const { group } of this.boats.values()) group.visible = false;
    for (let i = 0; i < this.posesCount; ++i) {
      const pose = this.poses[i]!;
      const boat = this.boats.get(pose.boatId);
      if (!boat) continue;
      const { group, detail } = boat;
      group.visible = true;
      group.position.set(pose.xM, pose.yM - sunkM(detail), pose.zM);
      group.rotation.set(pose.rollRad, -pose.headingRad, pose.pitchRad, "YZX");
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

  /** Returns the plans of the boats drawn now. */
  hulls(): HullPlan[] {
    return [...this.boats.values()]
      .filter(({ group }) => group.visible)
      .map(({ detail: { lengthM, beamM }, group: { position, rotation } }) => ({ xM: position.x, zM: position.z, headingRad: -rotation.y, lengthM, beamM }));
  }

  /** Adds the lights of the boats, as far as they are seen from the camera. */
  collectLamps(lamps: Lamps, cameraM: Vector3): void {
    for (const { detail, group, lamps: own } of this.boats.values()) if (group.visible) addBoatLamps(lamps, detail, group, own, cameraM);
  }

  dispose(): void {
    for (const boatId of [...this.boats.keys()]) this.drop(boatId);
  }

  private build(detail: BoatDetail): void {
    const colors = this.ownerColors.get(detail.boatId);
    const { hull, lid, lamps } = makeBoatParts(detail, colors, this.plain);
    const group = new Group();
    // Pitch (bow up) turns about z, roll (starboard down) about x. Headings turn from +x toward +z, opposite to three's y rotation.
    group.rotation.order = "YZX";
    group.visible = false;
    const cover = new Mesh(lid, this.lidMaterial);
    cover.renderOrder = 1;
    const body = new Mesh(hull, this.material);
    castsShadow(body);
    group.add(body, cover);
    this.boats.set(detail.boatId, { detail, colors, group, geometries: [hull, lid], lamps });
    this.scene.add(group);
  }

  private drop(boatId: number): void {
    const boat = this.boats.get(boatId);
    if (!boat) return;
    this.scene.remove(boat.group);
    for (const geometry of boat.geometries) geometry.dispose();
    this.boats.delete(boatId);
  }
}
