// The drops, foam and bubbles as points on the GPU. Several passes draw them, each those of its kind (whitewater.vert).
import { BufferGeometry, DynamicDrawUsage, InterleavedBuffer, InterleavedBufferAttribute, Points, Scene, type PerspectiveCamera, type RawShaderMaterial, type WebGLRenderer } from "three";

import { kFloatsPerParticle } from "./diffuse_particles";

export class WhitePoints {
  count = 0;
  private readonly scene = new Scene();
  private readonly points = new Points<BufferGeometry, RawShaderMaterial>(new BufferGeometry());
  private readonly values: InterleavedBuffer;

  /** `values`: kFloatsPerParticle per point; not copied. */
  constructor(values: Float32Array<ArrayBuffer>) {
    this.values = new InterleavedBuffer(values, kFloatsPerParticle);
    this.values.setUsage(DynamicDrawUsage);
    const geometry = this.points.geometry;
    geometry.setAttribute("position", new InterleavedBufferAttribute(this.values, 4, 0));
    geometry.setAttribute("a_motion", new InterleavedBufferAttribute(this.values, 4, 4));
    this.points.frustumCulled = false;
    this.scene.add(this.points);
  }

  /** Sends the first `count` points to the GPU. */
  upload(count: number): void {
    this.count = count;
    this.points.geometry.setDrawRange(0, count);
    if (count === 0) return;
    this.values.clearUpdateRanges();
    this.values.addUpdateRange(0, count * kFloatsPerParticle);
    this.values.needsUpdate = true;
  }

  /** Draws the points into the target that is set. */
  draw(renderer: WebGLRenderer, camera: PerspectiveCamera, material: RawShaderMaterial): void {
    if (this.count === 0) return;
    this.points.material = material;
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.points.geometry.dispose();
  }
}
