// Particles as ray-traced spheres. The 12 bytes of a plain particle go to the GPU unchanged, as six u16 in one interleaved buffer;
// the vertex shader reads them, so no JavaScript runs per particle.
import {
  BufferGeometry,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  Matrix4,
  Points,
  Vector2,
  Vector3,
  type PerspectiveCamera,
  type RawShaderMaterial,
  type Texture,
} from "three";

import { kParticleBytes } from "../codec/frame_types";
import type { ParticleFrame } from "../net/messages";
import { makeMaterial, type Uniforms } from "./shaders";
import type { Sky } from "./sky";

const kWordsPerParticle = kParticleBytes / 2;

export class ParticleCloud {
  readonly mesh: Points<BufferGeometry, RawShaderMaterial>;
  private readonly uniforms: Uniforms;
  private readonly sunDirection: Vector3;
  private words: InterleavedBuffer | undefined;
  private shown: ParticleFrame | undefined;

  /** `field` undefined: no surface over the particles. `depthM`: depth at which light from above has faded. */
  constructor(sky: Sky, field: Texture | undefined, sideM: number, depthM: number, quality: { plain: boolean; samplesCount: number }) {
    this.sunDirection = sky.sunDirection;
    this.uniforms = {
      ...sky.uniforms,
      u_camera_world: { value: new Matrix4() },
      u_inverse_projection: { value: new Matrix4() },
      u_sun_view: { value: new Vector3() },
      u_up_view: { value: new Vector3() },
      u_resolution: { value: new Vector2(1, 1) },
      u_min_m: { value: new Vector3() },
      u_max_m: { value: new Vector3() },
      u_max_speed_mps: { value: 0 },
      u_advance_s: { value: 0 },
      u_radius_m: { value: 1 },
      u_depth_m: { value: depthM },
      u_field: { value: field ?? null },
      u_side_m: { value: sideM },
      u_has_water: { value: field !== undefined },
    };
    // Soft edges: by alpha to coverage with several samples per pixel, by blending with one. Both write depth.
    const many = quality.samplesCount > 1;
    const soft = { alphaToCoverage: many, transparent: !many };
    const material = quality.plain
      ? makeMaterial("particlePlain", this.uniforms, { ...soft, defines: { PLAIN: 1 } })
      : makeMaterial("particle", this.uniforms, soft);
    this.mesh = new Points(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  /** Shows `frame`, extrapolated by its velocities for `advanceS` seconds. */
  show(frame: ParticleFrame, advanceS: number): void {
    this.uniforms["u_advance_s"]!.value = advanceS;
    if (frame === this.shown) return;
    this.shown = frame;
    this.mesh.visible = frame.count > 0;
    if (frame.count === 0) return;
    // A copy, because the frame's buffer returns to the worker when the ring drops the frame. The copy only grows, and only the used
    // part is uploaded. After a lost context the next frame fills it again.
    const wordsCount = frame.count * kWordsPerParticle;
    const words = this.words && this.words.array.length >= wordsCount ? this.words : this.rebuild(frame.buffer.byteLength / 2);
    words.array.set(new Uint16Array(frame.buffer, 0, wordsCount));
    words.clearUpdateRanges();
    words.addUpdateRange(0, wordsCount);
    words.needsUpdate = true;
    this.mesh.geometry.setDrawRange(0, frame.count);
    (this.uniforms["u_min_m"]!.value as Vector3).set(...frame.wordMinM);
    (this.uniforms["u_max_m"]!.value as Vector3).set(...frame.wordMaxM);
    this.uniforms["u_max_speed_mps"]!.value = frame.maxSpeedMps;
    this.uniforms["u_radius_m"]!.value = frame.radiusM;
  }

  update(camera: PerspectiveCamera, widthPx: number, heightPx: number): void {
    (this.uniforms["u_camera_world"]!.value as Matrix4).copy(camera.matrixWorld);
    (this.uniforms["u_inverse_projection"]!.value as Matrix4).copy(camera.projectionMatrixInverse);
    (this.uniforms["u_sun_view"]!.value as Vector3).copy(this.sunDirection).transformDirection(camera.matrixWorldInverse);
    (this.uniforms["u_up_view"]!.value as Vector3).set(0, 1, 0).transformDirection(camera.matrixWorldInverse);
    (this.uniforms["u_resolution"]!.value as Vector2).set(widthPx, heightPx);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private rebuild(wordsCount: number): InterleavedBuffer {
    this.mesh.geometry.dispose();
    const geometry = new BufferGeometry();
    const wholeCount = Math.floor(wordsCount / kWordsPerParticle) * kWordsPerParticle;
    const words = new InterleavedBuffer(new Uint16Array(wholeCount), kWordsPerParticle);
    geometry.setAttribute("position", new InterleavedBufferAttribute(words, 3, 0, true));
    geometry.setAttribute("a_packed", new InterleavedBufferAttribute(words, 3, 3, true));
    this.mesh.geometry = geometry;
    this.words = words;
    return words;
  }
}
