// The water: a grid displaced by the field, and vertical sides (the skirt) down to the floor where it has them. In the open sea the grid
// continues to the horizon and has no sides. Reads the field, the shore, the foam and the froth, the rain, the sea around, the
// shadow, and the solids, which are seen through the water and in its mirror. Writes the canvas and its depth.
// A camera close to the surface sees it from below as well (below_surface.ts).
import { type BufferGeometry, type DataTexture, DoubleSide, FrontSide, Mesh, type PerspectiveCamera, type RawShaderMaterial, Scene, type Side, type Texture, Vector2, Vector3, Vector4 } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { SurfaceFrame } from "../../net/messages";
import type { Pass, Picture } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import type { WarmUp } from "../drawing/warm_up";
import { makeGroundTexture } from "../landscape/ground_texture";
import { bedOf, bedUniformValues, isTank, longSideM } from "../landscape/terrain";
import type { Sky } from "../light/sky";
import { colourRatio } from "../light/water_optics";
import { clamp } from "../maths/interpolate";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import { BelowSurface } from "./below_surface";
import { makeWaterGeometries } from "./water_grid";

/** The water reflects solids as well as the sky. */
function hasSolids({ hasBoats, obstacles, beaches, hasBed, setting }: GreetingInfo): boolean {
  return hasBoats || obstacles.length > 0 || beaches.length > 0 || hasBed || setting !== "openSea";
}

/** A breaker without anything that floats on it, whose place would no longer be that of the water under it. */
function isDrawnUneven({ wave, hasBoats, hasFloaters }: GreetingInfo): boolean {
  return wave?.isSteepening === true && !hasBoats && !hasFloaters;
}

/** Thin water is drawn although the ground is in front of it by this share of a cell of the drawn surface: both are triangles, over a sloping bed. */
const kLiftPerCell = 0.1;

interface WaterTools {
  sky: Sky;
  noise: Texture;
  quality: Quality;
  warmUp: WarmUp;
}

interface WaterInputs {
  field: Texture;
  /** Undefined: the room sends none. */
  foam: Uniforms | undefined;
  froth: Texture;
  /** Undefined: no rings of rain. */
  rain: Uniforms | undefined;
  /** Returns the newest frame of the surface. */
  newest: () => SurfaceFrame | undefined;
}

export class WaterPass implements Pass {
  readonly name = "water";
  readonly reads = ["field", "shore", "foam", "froth", "rain", "sea", "shadow", "solids"] as const;
  readonly writes = ["canvas"] as const;
  private readonly scene = new Scene();
  private readonly meshes: Mesh<BufferGeometry, RawShaderMaterial>[];
  private readonly uniforms: Uniforms;
  private readonly grid: Mesh<BufferGeometry, RawShaderMaterial>;
  private readonly underside: Mesh<BufferGeometry, RawShaderMaterial>;
  private readonly below: BelowSurface;
  /** Materials of the plain tiers, by where the camera is. */
  private readonly plain: { surface: RawShaderMaterial; dived: RawShaderMaterial } | undefined;
  private readonly ground: DataTexture | undefined;

  constructor(greeting: GreetingInfo, solids: SolidsPass, { sky, noise, quality, warmUp }: WaterTools, { field, foam, froth, rain, newest }: WaterInputs) {
    const bed = bedOf(greeting);
    const { depthM, beaches } = bed;
    const { widthsM, shoreDepthsM } = bedUniformValues(bed);
    this.ground = makeGroundTexture(bed);
    const { edge } = solids.surroundings;
    const { color, depth } = solids.textures;
    const { caustics, shadow, shore } = solids.sunlight;
    this.uniforms = {
      ...sky.uniforms,
      ...caustics,
      ...shadow,
      ...shore,
      u_bed_light: { value: solids.bedLight },
      u_lift_m: { value: (kLiftPerCell * longSideM(bed)) / quality.surfaceCellsCount },
      u_field: { value: field },
      u_behind: { value: color },
      u_behind_depth: { value: depth },
      u_camera_m: { value: new Vector3() },
      u_resolution: { value: new Vector2(1, 1) },
      u_near_far_m: { value: new Vector2(1, 2) },
      u_extent_m: { value: new Vector2(bed.sideM, bed.widthM) },
      u_depth_m: { value: depthM },
      u_colour_ratio: { value: colourRatio(greeting) },
      u_beach_width_m: { value: new Vector4(...widthsM) },
      u_shore_depth_m: { value: new Vector4(...shoreDepthsM) },
      u_noise: { value: noise },
      u_lace_m: { value: isTank(greeting) ? 0.15 * Math.min(bed.sideM, bed.widthM) : clamp(Math.min(longSideM(bed) / 15, 0.8 * Math.min(bed.sideM, bed.widthM)), 0.5, 1.8) },
      u_froth: { value: froth },
      ...foam,
      ...rain,
      ...(edge.kind === "sea" ? edge.sea : edge.ripples),
      ...(this.ground && { u_ground: { value: this.ground } }),
    };
    const defines: Record<string, number> = {};
    if (quality.plain) defines["PLAIN"] = 1;
    if (beaches.length > 0 || this.ground) defines["BEACH"] = 1;
    if (this.ground) defines["GROUND"] = 1;
    if (shore) defines["SHORE"] = 1;
    if (foam) defines["FOAM"] = 1;
    if (rain) defines["RAIN"] = 1;
    if (hasSolids(greeting) && quality.mirrorStepsCount > 0) defines["MIRROR"] = quality.mirrorStepsCount;
    if (shadow) defines["SHADOWS"] = 1;
    if (edge.kind === "sea") defines["OPEN_SEA"] = 1;
    else if (edge.ripples) defines["RIPPLES"] = 1;
    if (edge.kind === "sea" && !quality.plain && isDrawnUneven(greeting)) defines["UNEVEN"] = 1;
    if (!quality.plain && edge.kind !== "walls") defines["HEAPED"] = 1;
    if (edge.kind === "cut") defines["GLASS"] = 1;
    const { top, sides } = makeWaterGeometries(edge, quality.surfaceCellsCount, greeting);
    // Plain water is blended over the solids. Its upper side is enough: only the real one shows the back of a steep wave.
    const surface = (side: Side, more: Record<string, number> = {}): RawShaderMaterial =>
      quality.plain
        ? makeMaterial("waterPlain", this.uniforms, { side: FrontSide, transparent: true, premultipliedAlpha: true, defines: { ...defines, ...more, VERTEX_LIT: 1 } })
        : makeMaterial("water", this.uniforms, { side, defines: { ...defines, ...more } });
    this.grid = new Mesh(top, surface(DoubleSide));
    warmUp([this.grid]);
    if (quality.plain) this.plain = { surface: this.grid.material, dived: surface(FrontSide, { DIVED: 1 }) };
    this.below = new BelowSurface(solids.floorAlbedo, isTank(greeting), this.uniforms, { ...defines, ...(caustics && { CAUSTICS: 1 }) }, newest, bed);
    this.underside = new Mesh(top, this.below.surface);
    this.meshes = [this.grid, this.underside];
    if (sides) this.meshes.push(new Mesh(sides, surface(FrontSide, { SKIRT: 1 })));
    for (const mesh of this.meshes) {
      mesh.frustumCulled = false;
      this.scene.add(mesh);
    }
  }

  draw({ renderer, camera, sizePx }: Picture): void {
    (this.uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    (this.uniforms["u_near_far_m"]!.value as Vector2).set(camera.near, camera.far);
    (this.uniforms["u_resolution"]!.value as Vector2).copy(sizePx);
    const isBelow = (this.underside.visible = this.below.isSeen(camera));
    if (this.plain) this.grid.material = isBelow ? this.plain.dived : this.plain.surface;
    else this.grid.material.side = isBelow ? FrontSide : DoubleSide;
    renderer.setRenderTarget(null);
    renderer.render(this.scene, camera);
  }

  /** Returns whether a picture from this camera shows the water from below. */
  isSeenFromBelow(camera: PerspectiveCamera): boolean {
    return this.below.isSeen(camera);
  }

  /** What is drawn where there is no surface, if the last picture shows the water from below. */
  get solidsBelow(): RawShaderMaterial | undefined {
    return this.underside.visible ? this.below.solids : undefined;
  }

  dispose(): void {
    for (const mesh of this.meshes) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    this.plain?.surface.dispose();
    this.plain?.dived.dispose();
    this.below.dispose();
    this.ground?.dispose();
  }
}
