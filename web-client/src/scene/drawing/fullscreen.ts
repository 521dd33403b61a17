// Draws one material over a whole render target.
import { BufferAttribute, BufferGeometry, Camera, Mesh, Scene, type RawShaderMaterial, type RenderTarget, type WebGLRenderer } from "three";

/** A triangle that covers clip space. */
export function makeFullscreenGeometry(): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
  return geometry;
}

export class FullscreenPass {
  private readonly scene = new Scene();
  private readonly camera = new Camera();
  private readonly mesh: Mesh;

  constructor(readonly material: RawShaderMaterial) {
    this.mesh = new Mesh(makeFullscreenGeometry(), material);
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  /** `instead`: another material, which the caller disposes. */
  render(renderer: WebGLRenderer, target: RenderTarget | null, instead?: RawShaderMaterial): void {
    this.mesh.material = instead ?? this.material;
    renderer.setRenderTarget(target as never);
    renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.material.dispose();
  }
}
