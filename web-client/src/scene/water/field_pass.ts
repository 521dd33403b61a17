// Surface frames → the field texture that every shader reads: elevation, slopes and curvature at the time shown. Where water moves over its
// shore, the field is that of the water's level, which continues over dry ground (level.frag).
// Reads the surface frames around that time. Writes the field.
import { ClampToEdgeWrapping, DataTexture, IntType, NearestFilter, RedIntegerFormat, RepeatWrapping, ShortType, Vector2, Vector3, Vector4, WebGLRenderTarget, type IUniform, type Texture, type WebGLRenderer } from "three";

import { kMaxResolutionCount } from "../../../client/codec/frame_types";
import type { WaveInfo } from "../../../client/codec/scene_info";
import type { SurfaceFrame } from "../../net/messages";
import { FullscreenPass } from "../drawing/fullscreen";
import type { Pass, Picture } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import type { Between, FrameRing } from "../frames/frame_ring";
import { FrameTextures, type PlaneCounts } from "../frames/frame_textures";
import { timeRateWeights, timeWeights, type FrameTimes } from "../frames/time_weights";
import { clamp } from "../maths/interpolate";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import { makeCellsTexture } from "../shore/cells_texture";
import type { ShoreCells } from "../shore/shore_ground";
import { kFilmM } from "../shore/shore_wetness";
import { kCurvature, kSlope, kSmooth } from "./field_kernels";
import type { LocalRipple } from "./local_ripple";
import type { WaterlinesPass } from "./waterlines_pass";

/** The elevation between frames is kept in fractions of the quantum: 15 bits and these 8 fill the 24 of a float. */
const kUnitsPerQuantum = 256;
/** Unit of the elevation before the first frame, which tells its quantum. */
const kUnitBeforeM = 1e-5;
/** Frames that a picture is interpolated from. */
const kFrameCount = 4;

/** What the field was drawn from last. The frames are in the ring until the next one arrives. */
export interface ShownSurfaces {
  /** Before, from, to and after the time shown. */
  readonly frames: readonly SurfaceFrame[];
  /** Of the frames in the elevation, and in its derivative by time [1/s]. */
  readonly weights: readonly [number, number, number, number];
  readonly ratesPerS: readonly [number, number, number, number];
  /** False with a single frame: the rates are 0. */
  isRateKnown: boolean;
}

export class FieldPass implements Pass {
  readonly name = "field";
  readonly reads = ["frames", "waterlines"] as const;
  readonly writes = ["field"] as const;
  /** Elevation (m), slope x, slope z, curvature (1/m); u along x and v along z, the water is 0..1. */
  readonly texture: Texture;
  private readonly target: WebGLRenderTarget;
  private readonly elevation: WebGLRenderTarget;
  private readonly frames: FrameTextures<SurfaceFrame>;
  private readonly interpolate: FullscreenPass;
  private readonly derive: FullscreenPass;
  /** Of a room whose water moves over its shore. */
  private readonly level: { pass: FullscreenPass; target: WebGLRenderTarget; cells: IUniform<DataTexture> } | undefined;
  // Of the picture drawn last; kept, because every picture would make new ones.
  private readonly times: FrameTimes = { beforeS: undefined, fromS: 0, toS: 0, afterS: undefined };
  private readonly weights: [number, number, number, number] = [0, 1, 0, 0];
  private readonly ratesPerS: [number, number, number, number] = [0, 0, 0, 0];
  private readonly drawn: SurfaceFrame[] = [];
  private readonly drawnFrom: ShownSurfaces = { frames: this.drawn, weights: this.weights, ratesPerS: this.ratesPerS, isRateKnown: false };

  private readonly sideM: number;
  private thinned: PlaneCounts;
  private readonly stride = { value: 1 };
  private isDrawn = false;

  /** The texture has as many texels as a surface has samples, at most `quality.fieldCountMax` per side. `cellsOf`: the ground by the counts of a frame, for a moving shore. */
  constructor(
    { sideM, widthM, periodicX, periodicZ, resolutionCount, countZ }: WaveInfo,
    private readonly surfaces: FrameRing<SurfaceFrame>,
    ripple: LocalRipple,
    waterlines: WaterlinesPass | undefined,
    private readonly quality: Pick<Quality, "fieldCountMax" | "texelType" | "plain">,
    private readonly cellsOf?: (counts: PlaneCounts) => ShoreCells,
  ) {
    this.sideM = sideM;
    const allowed = (count: number): number => clamp(count, 1, kMaxResolutionCount);
    const counts = { resolutionCount: allowed(resolutionCount), countZ: allowed(countZ) };
    this.thinned = this.thin(counts);
    this.target = new WebGLRenderTarget(...this.fieldCounts(this.thinned), {
      type: quality.texelType,
      wrapS: periodicX ? RepeatWrapping : ClampToEdgeWrapping,
      wrapT: periodicZ ? RepeatWrapping : ClampToEdgeWrapping,
      depthBuffer: false,
    });
    this.texture = this.target.texture;
    this.elevation = makeElevationTarget(this.thinned);
    this.frames = new FrameTextures<SurfaceFrame>(counts, kFrameCount, makeTexture);
    const { blank } = this.frames;
    const state = { depthTest: false, depthWrite: false };
    const unit = { value: kUnitBeforeM };
    this.interpolate = new FullscreenPass(
      makeMaterial(
        "elevation",
        {
          u_before: { value: blank },
          u_from: { value: blank },
          u_to: { value: blank },
          u_after: { value: blank },
          u_stride: this.stride,
          u_weights: { value: new Vector4(0, 0, 0, 0) },
          u_unit_m: unit,
          u_water_m: { value: new Vector2(sideM, widthM) },
          u_dents: ripple.dents,
          u_dent_count: ripple.count,
          ...(waterlines && { u_hulls: waterlines.hulls, u_hull_count: waterlines.count }),
        },
        state,
      ),
    );
    if (cellsOf) {
      const cells = { value: makeCellsTexture(cellsOf(this.thinned)) };
      const uniforms = { u_elevation: { value: this.elevation.texture }, u_unit_m: unit, u_cells: cells, u_film_m: { value: kFilmM } };
      this.level = { pass: new FullscreenPass(makeMaterial("level", uniforms, { ...state, defines: quality.plain ? { PLAIN: 1 } : {} })), target: makeElevationTarget(this.thinned), cells };
    }
    this.derive = new FullscreenPass(
      makeMaterial(
        "field",
        {
          u_elevation: { value: (this.level?.target ?? this.elevation).texture },
          u_unit_m: unit,
          u_cell_m: { value: 1 },
          u_cells_per_texel: { value: new Vector2(1, 1) },
          u_periodic: { value: new Vector2(Number(periodicX), Number(periodicZ)) },
          u_smooth: { value: new Vector3(...kSmooth) },
          u_slope: { value: new Vector3(...kSlope) },
          u_curvature: { value: new Vector3(...kCurvature) },
        },
        state,
      ),
    );
    this.scale();
  }

  /** What the last picture shows; undefined before the first frame. The next picture overwrites it. */
  get shown(): ShownSurfaces | undefined {
    return this.drawn.length > 0 ? this.drawnFrom : undefined;
  }

  /** The textures of the frames shown, as entries for materials. */
  get frameUniforms(): Uniforms {
    const { u_before, u_from, u_to, u_after } = this.interpolate.material.uniforms;
    return { u_before: u_before!, u_from: u_from!, u_to: u_to!, u_after: u_after! };
  }

  /** Texels of the field, and of the elevation and the level that it is drawn from. */
  get sizes(): { width: number; height: number; counts: PlaneCounts } {
    return { width: this.target.width, height: this.target.height, counts: this.thinned };
  }

  /** The level of the water in units of u_unit_m, and the ground below it, as entries for materials; of a room with a moving shore. */
  get levelUniforms(): Uniforms {
    return { u_level: { value: this.level!.target.texture }, u_unit_m: this.derive.material.uniforms["u_unit_m"]!, u_cells: this.level!.cells };
  }

  draw({ renderer, shownS }: Picture): void {
    const surfaces = shownS === undefined ? undefined : this.surfaces.around(shownS);
    if (surfaces) this.drawBetween(renderer, surfaces);
    else if (!this.isDrawn) this.drawStill(renderer);
    this.isDrawn = true;
  }

  dispose(): void {
    this.target.dispose();
    this.elevation.dispose();
    this.interpolate.dispose();
    this.derive.dispose();
    this.level?.target.dispose();
    this.level?.pass.dispose();
    this.level?.cells.value.dispose();
    this.frames.dispose();
  }

  /** Draws the field at a time between two frames; their neighbours give the curve between them. */
  private drawBetween(renderer: WebGLRenderer, between: Readonly<Between<SurfaceFrame>>): void {
    const { to, mix } = between;
    // The level of detail changed: frames of two sizes cannot be interpolated.
    const isLike = (frame: SurfaceFrame | undefined): frame is SurfaceFrame => frame?.resolutionCount === to.resolutionCount && frame.countZ === to.countZ;
    const from = isLike(between.from) ? between.from : to;
    const before = isLike(between.before) ? between.before : from;
    const after = isLike(between.after) ? between.after : to;
    if (!this.frames.fits(to)) this.resize({ resolutionCount: to.resolutionCount, countZ: to.countZ });

    const { times, weights, drawn } = this;
    times.beforeS = before === from ? undefined : before.timeS;
    times.fromS = from.timeS;
    times.toS = to.timeS;
    times.afterS = after === to ? undefined : after.timeS;
    timeWeights(times, mix, weights);
    this.drawnFrom.isRateKnown = timeRateWeights(times, mix, this.ratesPerS);
    const unitM = to.quantumM / kUnitsPerQuantum;
    const uniforms = this.interpolate.material.uniforms;
    drawn[0] = before;
    drawn[1] = from;
    drawn[2] = to;
    drawn[3] = after;
    uniforms["u_before"]!.value = this.frames.textureOf(before, drawn);
    uniforms["u_from"]!.value = this.frames.textureOf(from, drawn);
    uniforms["u_to"]!.value = this.frames.textureOf(to, drawn);
    uniforms["u_after"]!.value = this.frames.textureOf(after, drawn);
    const scaled = (k: 0 | 1 | 2 | 3): number => (weights[k] * drawn[k]!.quantumM) / unitM;
    (uniforms["u_weights"]!.value as Vector4).set(scaled(0), scaled(1), scaled(2), scaled(3));
    this.derive.material.uniforms["u_unit_m"]!.value = unitM;
    this.drawField(renderer);
  }

  /** Draws water at rest, until the first frame comes. */
  private drawStill(renderer: WebGLRenderer): void {
    (this.interpolate.material.uniforms["u_weights"]!.value as Vector4).set(0, 0, 0, 0);
    this.drawField(renderer);
  }

  private drawField(renderer: WebGLRenderer): void {
    this.interpolate.render(renderer, this.elevation);
    this.level?.pass.render(renderer, this.level.target);
    this.derive.render(renderer, this.target);
  }

  private resize(counts: PlaneCounts): void {
    this.frames.resize(counts);
    this.thinned = this.thin(counts);
    this.elevation.setSize(this.thinned.resolutionCount, this.thinned.countZ);
    if (this.level) {
      this.level.target.setSize(this.thinned.resolutionCount, this.thinned.countZ);
      this.level.cells.value.dispose();
      this.level.cells.value = makeCellsTexture(this.cellsOf!(this.thinned));
    }
    this.target.setSize(...this.fieldCounts(this.thinned));
    this.scale();
  }

  /** Returns the counts of the elevation: plain tiers read every second, third ... sample, so that no pass has more texels than the field. */
  private thin({ resolutionCount, countZ }: PlaneCounts): PlaneCounts {
    const stride = this.quality.plain ? Math.ceil(Math.max(resolutionCount, countZ) / this.quality.fieldCountMax) : 1;
    this.stride.value = stride;
    return { resolutionCount: Math.max(Math.floor(resolutionCount / stride), 1), countZ: Math.max(Math.floor(countZ / stride), 1) };
  }

  /** Texels along x and z: as many as samples, or as many as the quality allows along the longer side. */
  private fieldCounts({ resolutionCount, countZ }: PlaneCounts): [number, number] {
    const perTexel = Math.max(Math.max(resolutionCount, countZ) / this.quality.fieldCountMax, 1);
    return [Math.max(Math.round(resolutionCount / perTexel), 1), Math.max(Math.round(countZ / perTexel), 1)];
  }

  private scale(): void {
    const uniforms = this.derive.material.uniforms;
    const { resolutionCount, countZ } = this.thinned;
    uniforms["u_cell_m"]!.value = this.sideM / resolutionCount;
    (uniforms["u_cells_per_texel"]!.value as Vector2).set(resolutionCount / this.target.width, countZ / this.target.height);
  }
}

function makeElevationTarget({ resolutionCount, countZ }: PlaneCounts): WebGLRenderTarget {
  return new WebGLRenderTarget(resolutionCount, countZ, {
    format: RedIntegerFormat,
    type: IntType,
    internalFormat: "R32I",
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthBuffer: false,
  });
}

function makeTexture({ resolutionCount, countZ }: PlaneCounts): DataTexture {
  const texture = new DataTexture(new Int16Array(resolutionCount * countZ), resolutionCount, countZ, RedIntegerFormat, ShortType);
  texture.internalFormat = "R16I";
  texture.needsUpdate = true;
  return texture;
}
