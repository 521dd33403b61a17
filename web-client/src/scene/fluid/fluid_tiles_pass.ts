// Finds the tiles of the screen that particles touch, and draws over those tiles only. Reads the particles. Writes one byte per tile.
import { BufferAttribute, BufferGeometry, Camera, Mesh, NearestFilter, RedFormat, Scene, Vector2, WebGLRenderTarget, type RawShaderMaterial, type WebGLRenderer } from "three";

import type { Pass, Picture } from "../drawing/pass";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import type { FluidParticles } from "./fluid_particles";
import type { FluidVolumePass } from "./fluid_volume_pass";

const kColumnsCount = 48;
const kRowsCount = 32;

export class FluidTilesPass implements Pass {
  readonly name = "fluid tiles";
  readonly reads = ["particles", "fluidVolume"] as const;
  readonly writes = ["fluidTiles"] as const;
  /** For the materials of fluid_tile.vert. */
  readonly uniforms: Uniforms;
  private readonly target: WebGLRenderTarget;
  private readonly material: RawShaderMaterial;
  private readonly scene = new Scene();
  private readonly camera = new Camera();
  private readonly mesh: Mesh<BufferGeometry, RawShaderMaterial>;

  constructor(
    private readonly particles: FluidParticles,
    volume: FluidVolumePass,
  ) {
    this.target = new WebGLRenderTarget(kColumnsCount, kRowsCount, { format: RedFormat, minFilter: NearestFilter, magFilter: NearestFilter, depthBuffer: false });
    this.uniforms = { u_tiles: { value: this.target.texture }, u_tiles_count: { value: new Vector2(kColumnsCount, kRowsCount) } };
    const countPx = { u_target_px: { value: new Vector2(kColumnsCount, Math.max(kRowsCount, kColumnsCount)) } };
    this.material = makeMaterial("fluidTileMark", { ...particles.uniforms, ...volume.uniforms, ...countPx }, { depthTest: false, depthWrite: false });
    this.mesh = new Mesh(makeTiles(), this.material);
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  draw({ renderer, camera }: Picture): void {
    if (this.particles.isEmpty) return;
    // A tile is wider or narrower than high: the points are squares of the longer count.
    const across = kColumnsCount / camera.aspect;
    (this.material.uniforms["u_target_px"]!.value as Vector2).set(kColumnsCount, Math.max(kRowsCount, across));
    this.particles.render(renderer, camera, this.material, this.target);
  }

  /** Draws `material` over the marked tiles of `target`; nothing where there are no particles. */
  cover(renderer: WebGLRenderer, material: RawShaderMaterial, target: WebGLRenderTarget | null): void {
    if (this.particles.isEmpty) return;
    this.mesh.material = material;
    renderer.setRenderTarget(target);
    renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
    this.mesh.geometry.dispose();
  }
}

function makeTiles(): BufferGeometry {
  const positions = new Float32Array(kColumnsCount * kRowsCount * 18);
  let at = 0;
  for (let row = 0; row < kRowsCount; ++row)
    for (let column = 0; column < kColumnsCount; ++column)
      for (const corner of [0, 1, 2, 2, 1, 3]) {
        positions[at++] = column;
        positions[at++] = row;
        positions[at++] = corner;
      }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  return geometry;
}
