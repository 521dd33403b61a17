// The objects in the water: one mesh per kind, made when its first object comes, drawn once with an instance per object.
import { DynamicDrawUsage, InstancedBufferGeometry, InstancedInterleavedBuffer, InterleavedBufferAttribute, Mesh, type RawShaderMaterial, type Scene } from "three";

import { kMaxFloaterCount } from "../../../client/codec/frame_types";
import { kFloaterKinds, type FloaterKindName, type FloaterPose } from "../../../client/codec/floaters";
import { mixFloaters, type FloatersState } from "../frames/floaters";
import { castsShadow } from "../meshes/casters";
import { makeFloaterGeometry } from "./floater_meshes";
import { writePaint } from "./floater_paints";

/** Numbers per instance: middle and size, rotation, paint and shade (shaders/instance.glsl). */
const kInstanceNumbers = 12;
/** How much brighter an object is that somebody holds. */
const kHeldShade = 1.3;

interface KindMesh {
  mesh: Mesh<InstancedBufferGeometry>;
  buffer: InstancedInterleavedBuffer;
}

export class Floaters {
  private readonly meshes = new Map<FloaterKindName, KindMesh>();
  private readonly poses: FloaterPose[] = [];
  private posesCount = 0;
  /** The call that the meshes show. */
  private shown: { from: FloatersState; to: FloatersState; mix: number } | undefined;

  /** The caller disposes `material`, which has the define INSTANCES. */
  constructor(
    private readonly scene: Scene,
    private readonly material: RawShaderMaterial,
    private readonly water: { sideM: number; widthM: number },
    private readonly plain: boolean,
  ) {}

  show(from: FloatersState, to: FloatersState, mix: number): void {
    // Shadows and solids of one picture ask for the same.
    if (this.shown?.from === from && this.shown.to === to && this.shown.mix === mix) return;
    this.shown = { from, to, mix };
    this.posesCount = Math.min(mixFloaters(from, to, mix, this.water, this.poses), kMaxFloaterCount);
    for (const kind of kFloaterKinds) this.fill(kind);
  }

  /** Returns the objects as they are drawn now. The next picture overwrites them. */
  drawn(): FloaterPose[] {
    return this.poses.slice(0, this.posesCount);
  }

  dispose(): void {
    for (const { mesh } of this.meshes.values()) {
      this.scene.remove(mesh);
      mesh.geometry.dispose();
    }
  }

  private fill(kind: FloaterKindName): void {
    let count = 0;
    for (let i = 0; i < this.posesCount; ++i) {
      const pose = this.poses[i]!;
      if (pose.kind === kind) write(pose, this.meshOf(kind).buffer.array as Float32Array, kInstanceNumbers * count++);
    }
    const made = this.meshes.get(kind);
    if (!made) return;
    made.mesh.visible = count > 0;
    made.mesh.geometry.instanceCount = count;
    made.buffer.clearUpdateRanges();
    made.buffer.addUpdateRange(0, kInstanceNumbers * count);
    made.buffer.needsUpdate = count > 0;
  }

  private meshOf(kind: FloaterKindName): KindMesh {
    const known = this.meshes.get(kind);
    if (known) return known;
    const one = makeFloaterGeometry(kind, this.plain);
    const geometry = new InstancedBufferGeometry();
    for (const name of ["position", "normal", "color"]) geometry.setAttribute(name, one.getAttribute(name));
    geometry.setIndex(one.getIndex());
    const buffer = new InstancedInterleavedBuffer(new Float32Array(kInstanceNumbers * kMaxFloaterCount), kInstanceNumbers);
    buffer.setUsage(DynamicDrawUsage);
    ["place", "turn", "paint"].forEach((name, k) => geometry.setAttribute(name, new InterleavedBufferAttribute(buffer, 4, 4 * k)));
    const mesh = new Mesh(geometry, this.material);
    mesh.frustumCulled = false;
    castsShadow(mesh, "instance");
    this.scene.add(mesh);
    const made = { mesh, buffer };
    this.meshes.set(kind, made);
    return made;
  }
}

function write({ floaterId, kind, xM, yM, zM, sizeM, turn, isHeld }: FloaterPose, out: Float32Array, at: number): void {
  out[at] = xM;
  out[at + 1] = yM;
  out[at + 2] = zM;
  out[at + 3] = sizeM;
  out.set(turn, at + 4);
  writePaint(kind, floaterId, out, at + 8);
  out[at + 11] = isHeld ? kHeldShade : 1;
}
