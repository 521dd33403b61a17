// The particles of a tank in the tier minimal: a mesh made on the CPU (plain_surface.ts), lit at its vertices, with its drops and its shade on the
// floor. Reads the particles, and the canvas with the solids. Writes the canvas and its depth.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, InterleavedBuffer, InterleavedBufferAttribute, Mesh, PlaneGeometry, Points, Scene, Vector3, type RawShaderMaterial, type Texture } from "three";

import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { kDarkening, makeMaterial } from "../shaders/materials";
import type { FluidParticles } from "./fluid_particles";
import { kDropFloats, kVertexFloats, PlainSurface } from "./plain_surface";

/** Cells of the mesh that shades the floor. */
const kFloorCells = [40, 20] as const;
/** Light lost per length of water, in widths of the tank, and the most of it. */
const kShadePerWidth = 1.6;
const kMostShade = 0.45;
/** One tile of the noise in particle radii. */
const kLaceRadii = 22;

export class PlainLiquidPass implements Pass {
  readonly name = "plain liquid";
  readonly reads = ["particles", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  readonly surface = new PlainSurface();
  private readonly scene = new Scene();
  private readonly materials: RawShaderMaterial[];
  private readonly meshes: Mesh<BufferGeometry>[];
  private readonly drops: Points<BufferGeometry>;
  private readonly floor: Mesh<PlaneGeometry>;
  private readonly own;

  constructor(
    private readonly particles: FluidParticles,
    /** Of the water, m. */
    private readonly size: { sideM: number; widthM: number },
    private readonly surroundings: { readonly floorM: number },
    private readonly sky: Sky,
    noise: Texture,
    colourRatio: number,
  ) {
    this.own = { u_camera_m: { value: new Vector3() }, u_half_m: { value: new Vector3(size.sideM / 2, size.widthM / 2, 1) }, u_floor_m: { value: 0 }, u_lace_m: { value: 1 }, u_height_px: { value: 1 } };
    const uniforms = { ...sky.uniforms, ...this.own, u_noise: { value: noise }, u_colour_ratio: { value: colourRatio } };
    const blended = { transparent: true, premultipliedAlpha: true };
    // Its depth comes first: of what overlaps only the nearest is seen.
    const depth = makeMaterial("fluidPlain", uniforms, { ...blended, colorWrite: false });
    const light = makeMaterial("fluidPlain", uniforms, { ...blended, depthWrite: false });
    const drop = makeMaterial("fluidPlainDrop", uniforms, { transparent: true, depthWrite: false });
    const shade = makeMaterial("fluidPlainFloor", {}, kDarkening);
    this.materials = [depth, light, drop, shade];
    this.floor = new Mesh(new PlaneGeometry(size.sideM, size.widthM, ...kFloorCells).rotateX(-Math.PI / 2), shade);
    this.floor.geometry.setAttribute("a_passed", new BufferAttribute(new Float32Array(this.floor.geometry.getAttribute("position").count).fill(1), 1).setUsage(DynamicDrawUsage));
    const geometry = new BufferGeometry();
    this.meshes = [new Mesh(geometry, depth), new Mesh(geometry, light)];
    const dropsGeometry = new BufferGeometry();
    const words = new InterleavedBuffer(this.surface.drops, kDropFloats).setUsage(DynamicDrawUsage);
    dropsGeometry.setAttribute("position", new InterleavedBufferAttribute(words, 3, 0));
    dropsGeometry.setAttribute("a_radius_white", new InterleavedBufferAttribute(words, 2, 3));
    this.drops = new Points(dropsGeometry, drop);
    [this.floor, ...this.meshes, this.drops].forEach((object, order) => {
      object.frustumCulled = false;
      object.renderOrder = order;
      this.scene.add(object);
    });
  }

  draw({ renderer, camera, sizePx }: Picture): void {
    const { particles, surface, own, size } = this;
    const { values } = particles;
    if (!values) return;
    const { floorM } = this.surroundings;
    surface.build(values, particles.bounds.maxM[1], { ...size, floorM }, camera.position.toArray());
    own.u_camera_m.value.copy(camera.position);
    own.u_half_m.value.z = 2 * particles.radiusM;
    own.u_floor_m.value = floorM;
    own.u_lace_m.value = kLaceRadii * particles.radiusM;
    own.u_height_px.value = sizePx.y;
    this.takeMesh();
    this.takeDrops();
    this.shadeFloor(floorM);
    renderer.setRenderTarget(null);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    for (const material of this.materials) material.dispose();
    for (const { geometry } of [this.meshes[0]!, this.drops, this.floor]) geometry.dispose();
  }

  private takeMesh(): void {
    const { surface } = this;
    let { geometry } = this.meshes[0]!;
    const words = geometry.getAttribute("position") as InterleavedBufferAttribute | undefined;
    // Its arrays have grown.
    if (words?.data.array !== surface.vertices || geometry.index?.array !== surface.indices) {
      geometry.dispose();
      geometry = new BufferGeometry();
      const vertices = new InterleavedBuffer(surface.vertices, kVertexFloats).setUsage(DynamicDrawUsage);
      geometry.setAttribute("position", new InterleavedBufferAttribute(vertices, 3, 0));
      geometry.setAttribute("normal", new InterleavedBufferAttribute(vertices, 3, 3));
      geometry.setAttribute("a_length_white", new InterleavedBufferAttribute(vertices, 2, 6));
      geometry.setIndex(new BufferAttribute(surface.indices, 1).setUsage(DynamicDrawUsage));
      for (const mesh of this.meshes) mesh.geometry = geometry;
    } else {
      upload(words.data, kVertexFloats * surface.verticesCount);
      upload(geometry.index, surface.indicesCount);
    }
    geometry.setDrawRange(0, surface.indicesCount);
  }

  private takeDrops(): void {
    const { geometry } = this.drops;
    upload((geometry.getAttribute("position") as InterleavedBufferAttribute).data, kDropFloats * this.surface.dropsCount);
    geometry.setDrawRange(0, this.surface.dropsCount);
    this.drops.visible = this.surface.dropsCount > 0;
  }

  private shadeFloor(floorM: number): void {
    const { x, y, z } = this.sky.sunDirection;
    const position = this.floor.geometry.getAttribute("position");
    const passed = this.floor.geometry.getAttribute("a_passed") as BufferAttribute;
    this.floor.position.y = floorM;
    for (let n = 0; n < position.count; ++n) {
      const lengthM = y > 0.1 ? this.surface.lengthM(position.getX(n), floorM, position.getZ(n), x, y, z) : 0;
      passed.setX(n, 1 - kMostShade * (1 - Math.exp((-kShadePerWidth * lengthM) / this.size.widthM)));
    }
    passed.needsUpdate = true;
  }
}

/** Uploads the first `count` numbers. */
function upload(buffer: InterleavedBuffer | BufferAttribute, count: number): void {
  buffer.clearUpdateRanges();
  buffer.addUpdateRange(0, count);
  buffer.needsUpdate = true;
}
