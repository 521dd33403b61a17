// The particles of the time shown, on the GPU: the 12 bytes of a plain particle unchanged, as six u16 in one interleaved buffer, so no
// JavaScript runs per particle. Several passes draw them as points. Reads the particle frames. Writes
// the particles.
import { BufferGeometry, InterleavedBuffer, InterleavedBufferAttribute, Points, Scene, Vector2, Vector3, type PerspectiveCamera, type RawShaderMaterial, type RenderTarget, type Texture, type WebGLRenderer } from "three";

import type { ParticleFrame } from "../../net/messages";
import type { Pass, Picture } from "../drawing/pass";
import type { FrameRing } from "../frames/frame_ring";
import { kWordsPerParticle, type ShownParticles } from "../frames/particle_values";
import type { PlayoutClock } from "../frames/playout_clock";
import { clamp } from "../maths/interpolate";
import type { Uniforms } from "../shaders/materials";

/** Particles are extrapolated for at most this many frame intervals. */
const kMaxAdvanceIntervals = 1.5;

export class FluidParticles implements Pass {
  readonly name = "particles";
  readonly reads = ["frames"] as const;
  readonly writes = ["particles"] as const;
  /** For shaders that include fluid_words.glsl, and for those that compare particles with the wave. */
  readonly uniforms: Uniforms;
  private readonly scene = new Scene();
  private readonly points = new Points<BufferGeometry, RawShaderMaterial>(new BufferGeometry());
  private words: InterleavedBuffer | undefined;
  private shown: ParticleFrame | undefined;

  /** `field` undefined: no wave around the particles. */
  constructor(
    private readonly frames: FrameRing<ParticleFrame>,
    private readonly clock: PlayoutClock,
    field: Texture | undefined,
    size: { sideM: number; widthM: number },
  ) {
    this.uniforms = {
      u_min_m: { value: new Vector3() },
      u_max_m: { value: new Vector3() },
      u_max_speed_mps: { value: 0 },
      u_advance_s: { value: 0 },
      u_radius_m: { value: 1 },
      u_field: { value: field ?? null },
      u_extent_m: { value: new Vector2(size.sideM, size.widthM) },
      u_has_water: { value: field !== undefined },
    };
    this.points.frustumCulled = false;
    this.scene.add(this.points);
  }

  /** No particles are there now: the passes have nothing to draw. */
  get isEmpty(): boolean {
    return !this.shown || this.shown.count === 0;
  }

  /** Where the particles shown are, m: lowest and highest x, y, z. */
  get bounds(): { minM: [number, number, number]; maxM: [number, number, number] } {
    return this.shown!;
  }

  /** Radius of the particles shown. */
  get radiusM(): number {
    return this.shown?.radiusM ?? 1;
  }

  /** Takes the particles of the time shown: those of the frame before, extrapolated by their velocities. */
  draw({ shownS }: Picture): void {
    const frames = shownS === undefined ? undefined : this.frames.around(shownS);
    if (frames) this.show(frames.from, clamp(shownS! - frames.from.timeS, 0, kMaxAdvanceIntervals * this.clock.intervalS()));
  }

  /** The particles of the last picture, for values on the CPU; undefined without particles. */
  get values(): ShownParticles | undefined {
    return this.isEmpty ? undefined : { frame: this.shown!, words: this.words!.array as Uint16Array, advanceS: this.uniforms["u_advance_s"]!.value as number };
  }

  /** Clears the target and draws the particles into it. */
  render(renderer: WebGLRenderer, camera: PerspectiveCamera, material: RawShaderMaterial, target: RenderTarget): void {
    renderer.setRenderTarget(target as never);
    renderer.clear();
    this.renderOver(renderer, camera, material, target);
  }

  /** Draws the particles over what the target shows. */
  renderOver(renderer: WebGLRenderer, camera: PerspectiveCamera, material: RawShaderMaterial, target: RenderTarget | null): void {
    this.points.material = material;
    renderer.setRenderTarget(target as never);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.points.geometry.dispose();
  }

  private show(frame: ParticleFrame, advanceS: number): void {
    this.uniforms["u_advance_s"]!.value = advanceS;
    if (frame === this.shown) return;
    this.shown = frame;
    if (frame.count === 0) return;
    // A copy, because the frame's buffer returns to the worker when the ring drops the frame. The copy only grows, and only the used
    // part is uploaded. After a lost context the next frame fills it again.
    const wordsCount = frame.count * kWordsPerParticle;
    const words = this.words && this.words.array.length >= wordsCount ? this.words : this.rebuild(frame.buffer.byteLength / 2);
    words.array.set(new Uint16Array(frame.buffer, 0, wordsCount));
    words.clearUpdateRanges();
    words.addUpdateRange(0, wordsCount);
    words.needsUpdate = true;
    this.points.geometry.setDrawRange(0, frame.count);
    (this.uniforms["u_min_m"]!.value as Vector3).set(...frame.wordMinM);
    (this.uniforms["u_max_m"]!.value as Vector3).set(...frame.wordMaxM);
    this.uniforms["u_max_speed_mps"]!.value = frame.maxSpeedMps;
    this.uniforms["u_radius_m"]!.value = frame.radiusM;
  }

  private rebuild(wordsCount: number): InterleavedBuffer {
    this.points.geometry.dispose();
    const geometry = new BufferGeometry();
    const wholeCount = Math.floor(wordsCount / kWordsPerParticle) * kWordsPerParticle;
    const words = new InterleavedBuffer(new Uint16Array(wholeCount), kWordsPerParticle);
    geometry.setAttribute("position", new InterleavedBufferAttribute(words, 3, 0, true));
    geometry.setAttribute("a_packed", new InterleavedBufferAttribute(words, 3, 3, true));
    this.points.geometry = geometry;
    this.words = words;
    return words;
  }
}
