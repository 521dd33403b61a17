// Draws everything of one room: the list of its passes, each with what it reads and writes, in the order in which they are drawn.
//   field      frames -> field (elevation, slopes, curvature of the water)
//   foam       frames -> foam
//   sea        time -> the sea around the square, in an open sea
//   solids     sky, ground, rocks, boats -> solids (linear light, depth)
//   particles  frames -> particles; their shadow -> solids (fluid/fluid.ts)
//   water      field, foam, sea, solids -> canvas
//   present    solids -> canvas where there is no water
//   fluid      particles, solids -> canvas (fluid/fluid.ts)
//   glass      panes of a tank -> canvas
// Other looks than the natural one draw the water with passes of their own (looks/look_room.ts).
import { PerspectiveCamera, Vector2, type WebGLRenderer } from "three";

import type { BoatDetail, GreetingInfo } from "../codec/greeting";
import type { Frame, SurfaceFrame } from "../net/messages";
import type { BodyPose } from "./bodies";
import { makeFluidPasses } from "./fluid/fluid";
import type { ViewedBox } from "./framing";
import { elevationAtM, elevationRangeM } from "./height_field";
import { LookRoom, type Legend, type Reading } from "./looks/look_room";
import { looksOf, type LookName } from "./looks/looks";
import { makeNoiseTexture } from "./noise_texture";
import { FieldPass } from "./passes/field_pass";
import { FoamPass } from "./passes/foam_pass";
import { GlassPass } from "./passes/glass_pass";
import type { Pass, Picture } from "./passes/pass";
import { PresentPass } from "./passes/present_pass";
import { SolidsPass } from "./passes/solids_pass";
import { WaterPass } from "./passes/water_pass";
import type { Ray, WaterShape } from "./pick";
import type { Quality } from "./quality";
import { isIndoors, viewOf } from "./settings/surroundings";
import { Sky } from "./sky";
import { StreamedFrames } from "./streamed_frames";

/** Room for waves above the water in a view, as a share of its side. */
const kWaveRoom = 0.04;
/** Sides of the square per near plane, and sides of the square at the far plane: behind the last cell of an open sea. */
const kNearPerSide = 160;
const kFarSides = 500;

/** The passes of one room that all looks share. `field` undefined: there is no wave. */
interface Base {
  field: FieldPass | undefined;
  foam: FoamPass | undefined;
  solids: SolidsPass;
  passes: readonly Pass[];
}

export class WaterScene {
  readonly camera = new PerspectiveCamera(47, 1, 0.1, 1000);
  private readonly frames: StreamedFrames;
  private readonly sky: Sky;
  private readonly noise = makeNoiseTexture();
  private readonly picture: Picture;
  /** What every look needs: field, foam, surroundings. */
  private base: Base | undefined;
  /** The water in the look shown. */
  private water: readonly Pass[] = [];
  private lookRoom: LookRoom | undefined;
  /** Those of the above whose results are used, in the order in which they are drawn. */
  private passes: readonly Pass[] = [];
  private wantedLook: LookName = "natural";
  private greeting: GreetingInfo | undefined;

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly quality: Quality,
    release: (frame: Frame) => void,
  ) {
    this.frames = new StreamedFrames(release);
    this.sky = new Sky(quality.samplesCount > 1);
    this.picture = { renderer, camera: this.camera, sizePx: new Vector2(), shownS: undefined };
    renderer.autoClear = false;
  }

  get clock() {
    return this.frames.clock;
  }

  /** Builds the passes of this room and disposes those of the one before. */
  enter(greeting: GreetingInfo): void {
    this.leave();
    this.greeting = greeting;
    this.frames.enter(greeting.wave !== undefined);
    this.base = this.makeBase(greeting);
    this.makeWater();
    this.camera.near = greeting.sideM / kNearPerSide;
    this.camera.far = greeting.sideM * kFarSides;
    this.camera.updateProjectionMatrix();
  }

  /** Draws one picture; `drawn` is called after each pass. */
  render(nowS: number, drawn?: (pass: Pass) => void): void {
    const { renderer, camera, picture } = this;
    picture.shownS = this.clock.displayTimeS(nowS);
    renderer.getDrawingBufferSize(picture.sizePx);
    camera.updateMatrixWorld();
    renderer.setRenderTarget(null);
    renderer.clear();
    for (const pass of this.passes) {
      pass.draw(picture);
      drawn?.(pass);
    }
    this.lookRoom?.measure(nowS);
  }

  /** The look shown: the wanted one, or the natural one where the room lacks its data. */
  get look(): LookName {
    return this.greeting && looksOf(this.greeting).includes(this.wantedLook) ? this.wantedLook : "natural";
  }

  /** Shows the water in another look, in this room and those after it. */
  setLook(look: LookName): void {
    this.wantedLook = look;
    this.makeWater();
  }

  /** What the colours of the look mean; undefined for looks without values. */
  get legend(): Legend | undefined {
    return this.lookRoom?.legend;
  }

  /** Returns the look's value where the ray meets the water of the last picture. Call it before the next frame arrives. */
  probe(ray: Ray): Reading | undefined {
    const { shownS } = this.picture;
    return shownS === undefined ? undefined : this.lookRoom?.probe(ray, shownS);
  }

  /** Takes ownership of a frame; `nowS`: client time. */
  take(frame: Frame, nowS: number): void {
    if (frame.layer === "particles" && !this.greeting?.wave && frame.count > 0) this.base?.solids.surroundings.setFloorM(frame.minM[1] - frame.radiusM);
    this.frames.take(frame, nowS);
  }

  /** Sets the boats on the water. */
  setBoats(boats: readonly BoatDetail[]): void {
    if (this.greeting) this.greeting.boats = [...boats];
    this.base?.solids.setBoats(boats);
  }

  /** Returns the pose in which a boat is drawn now. The next frame overwrites it. */
  poseOf(boatId: number): BodyPose | undefined {
    return this.base?.solids.poseOf(boatId);
  }

  drawnBoats(): BodyPose[] {
    return this.base?.solids.drawnBoats() ?? [];
  }

  /** Returns the box that a view shows: the water with room for waves, or the bounds of the newest particle frame. */
  viewedBox(): ViewedBox | undefined {
    if (!this.greeting) return undefined;
    const { sideM, widthM, wave } = this.greeting;
    const view = viewOf(this.greeting);
    if (wave) return { ...view, sideM, widthM, minYM: -wave.depthM, maxYM: kWaveRoom * sideM };
    const frame = this.frames.particles.newest();
    return frame && { ...view, sideM, widthM, minYM: frame.minM[1] - frame.radiusM, maxYM: frame.maxM[1] + frame.radiusM };
  }

  newestSurface(): SurfaceFrame | undefined {
    return this.frames.surfaces.newest();
  }

  /** Returns the surface for picking: the newest elevations, or flat water before the first frame. */
  shape(): WaterShape | undefined {
    if (!this.greeting) return undefined;
    const { sideM } = this.greeting;
    const frame = this.newestSurface();
    if (!frame) return { sideM, minM: 0, maxM: 0, elevationAtM: () => 0 };
    return { sideM, ...elevationRangeM(frame), elevationAtM: (xM, zM) => elevationAtM(frame, xM, zM) };
  }

  /** Follows a parameter of the room, by its path in the scene. */
  setParameter(path: string, value: number): void {
    this.base?.solids.surroundings.setParameter(path, value);
  }

  /** Draws again what exists only on the GPU. */
  contextRestored(): void {
    if (this.greeting) this.enter(this.greeting);
  }

  dispose(): void {
    this.leave();
    this.sky.dispose();
    this.noise.dispose();
  }

  private makeBase(greeting: GreetingInfo): Base {
    const { frames, sky, noise, quality } = this;
    const { wave } = greeting;
    sky.bake(this.renderer, isIndoors(greeting));
    sky.hideBelowHorizon(greeting.setting === "openSea");
    const field = wave && new FieldPass(wave, frames.surfaces, quality.fieldCountMax);
    const foam = wave && greeting.layers.includes("foam") ? new FoamPass(frames.foam, wave.periodicX, wave.periodicZ) : undefined;
    const solids = new SolidsPass(greeting, sky, noise, field?.texture, frames.bodies, quality);
    return { field, foam, solids, passes: [field, foam, solids.surroundings.sea, solids].filter((pass) => pass !== undefined) };
  }

  private makeWater(): void {
    const { base, greeting } = this;
    if (!base || !greeting) return;
    this.leaveWater();
    if (this.look !== "natural") this.lookRoom = new LookRoom(this.look, greeting, { ...base, frames: this.frames, sky: this.sky, quality: this.quality });
    this.water = this.lookRoom?.passes ?? this.makeNaturalWater(greeting, base);
    this.passes = usedPasses([...base.passes, ...this.water]);
  }

  private makeNaturalWater(greeting: GreetingInfo, { field, foam, solids }: Base): Pass[] {
    const { frames, sky, noise, quality } = this;
    const { glass } = solids.surroundings;
    const water = field && new WaterPass(greeting, sky, noise, field.texture, foam?.uniforms, solids, quality);
    const fluid = greeting.hasParticles ? makeFluidPasses(frames, solids, sky, noise, field?.texture, greeting.sideM, quality.fluid) : { before: [], after: [] };
    return [...fluid.before, water, new PresentPass(sky, solids), ...fluid.after, glass && new GlassPass(glass)].filter((pass) => pass !== undefined);
  }

  private leaveWater(): void {
    if (this.lookRoom) this.lookRoom.dispose();
    else for (const pass of this.water) pass.dispose();
    this.lookRoom = undefined;
    this.water = this.passes = [];
  }

  private leave(): void {
    this.leaveWater();
    for (const pass of this.base?.passes ?? []) pass.dispose();
    this.base = undefined;
  }
}

/** Leaves out passes whose results no later pass reads. */
function usedPasses(passes: readonly Pass[]): Pass[] {
  const used: Pass[] = [];
  for (const pass of [...passes].reverse())
    if (pass.writes.some((written) => written === "canvas" || used.some(({ reads }) => reads.includes(written)))) used.unshift(pass);
  return used;
}
