// Particles as ray-traced spheres. The wire's 12 bytes go to the GPU as they are: six u16 a particle in one interleaved
// buffer, unpacked by the vertex shader; no JavaScript touches a particle.
import {
  BufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Matrix4,
  Mesh,
  Vector3,
  type RawShaderMaterial,
} from "three";

import { kParticleBytes } from "../codec/parse";
import type { ParticleFrame } from "../net/messages";
import { makeMaterial, type Uniforms } from "./shaders";
import type { Sky } from "./sky";

const kWordsPerParticle = kParticleBytes / 2;

export class ParticleCloud {
  readonly mesh: Mesh<InstancedBufferGeometry, RawShaderMaterial>;
  private readonly uniforms: Uniforms;
  private words: InstancedInterleavedBuffer | undefined;
  private shown: ParticleFrame | undefined;

  /** `depthM`: how far below y = 0 the light has faded. */
  constructor(sky: Sky, depthM: number) {
    this.uniforms = {
      ...sky.uniforms,
      u_camera_world: { value: new Matrix4() },
      u_min_m: { value: new Vector3() },
      u_max_m: { value: new Vector3() },
      u_max_speed_mps: { value: 0 },
      u_advance_s: { value: 0 },
      u_radius_m: { value: 1 },
      u_depth_m: { value: depthM },
    };
    this.mesh = new Mesh(new InstancedBufferGeometry(), makeMaterial("particle", this.uniforms));
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  /** Shows `frame` moved on by its velocities for `advanceS` seconds. */
  show(frame: ParticleFrame, advanceS: number, cameraWorld: Matrix4): void {
    (this.uniforms["u_camera_world"]!.value as Matrix4).copy(cameraWorld);
    this.uniforms["u_advance_s"]!.value = advanceS;
    if (frame === this.shown) return;
    this.shown = frame;
    this.mesh.visible = frame.count > 0;
    if (frame.count === 0) return;
    const words = new Uint16Array(frame.buffer);
    // The buffer itself goes back to the worker when the ring drops the frame; the GPU's copy is refreshed from here
    // once, and a restored context is filled by the next frame.
    if (!this.words || this.words.array.length !== words.length) this.rebuild(words.slice());
    else {
      this.words.array.set(words);
      this.words.needsUpdate = true;
    }
    (this.uniforms["u_min_m"]!.value as Vector3).set(...frame.minM);
    (this.uniforms["u_max_m"]!.value as Vector3).set(...frame.maxM);
    this.uniforms["u_max_speed_mps"]!.value = frame.maxSpeedMps;
    this.uniforms["u_radius_m"]!.value = frame.radiusM;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private rebuild(words: Uint16Array): void {
    this.mesh.geometry.dispose();
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.words = new InstancedInterleavedBuffer(words, kWordsPerParticle, 1);
    geometry.setAttribute("a_place", new InterleavedBufferAttribute(this.words, 3, 0, true));
    geometry.setAttribute("a_packed", new InterleavedBufferAttribute(this.words, 3, 3, true));
    geometry.instanceCount = words.length / kWordsPerParticle;
    this.mesh.geometry = geometry;
  }
}
