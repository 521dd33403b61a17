// Draws everything of one room: the list of its passes, each with what it reads and writes, in the order in which they are drawn.
//   field      frames -> field (elevation, slopes, curvature of the water)
//   caustics   field -> sunlight that the waves focus on what is below them; not at low quality
//   foam       frames -> foam
//   sea        time -> the sea around the square, in an open sea
//   shadow     frames, field -> what the sun sees of solids; not at low quality
//   solids     sky, ground, rocks, boats -> solids (linear light, depth)
//   particles  frames -> particles; their shadow -> solids (fluid/fluid.ts)
//   whitewater frames, boats -> drops, foam, bubbles; froth; bubbles -> solids (whitewater/whitewater.ts)
//   flat shadow  frames -> froth; at low quality
//   water      field, foam, froth, sea, shadow, solids -> canvas
//   present    solids -> canvas where there is no water
//   fluid      particles, solids -> canvas (fluid/fluid.ts)
//   spray      drops, solids -> canvas
//   lamps      solids, field -> canvas, in the dark
//   glass      panes of a tank -> canvas
import { PerspectiveCamera, Vector2, type WebGLRenderer } from "three";

import type { BoatDetail, GreetingInfo } from "../codec/greeting";
import type { PersonInfo } from "../codec/people";
import type { Frame, SurfaceFrame } from "../net/messages";
import type { BodyPose } from "./bodies";
import { makeFluidPasses } from "./fluid/fluid";
import type { ViewedBox } from "./framing";
import { diveWater, type DiveWater } from "./dive";
import { elevationAtM, elevationRangeM } from "./height_field";
import { Daylight } from "./light/daylight";
import { darknessOf, type Light } from "./light/light";
import { makeNoiseTexture } from "./noise_texture";
import { CausticsPass } from "./passes/caustics_pass";
import { FieldPass } from "./passes/field_pass";
import { FoamPass } from "./passes/foam_pass";
import { FlatShadowPass } from "./passes/flat_shadow_pass";
import { GlassPass } from "./passes/glass_pass";
import { LampsPass } from "./passes/lamps_pass";
import type { Pass, Picture } from "./passes/pass";
import { PresentPass } from "./passes/present_pass";
import { ShadowPass } from "./passes/shadow_pass";
import { SolidsPass } from "./passes/solids_pass";
import { WaterPass } from "./passes/water_pass";
import type { WaterShape } from "./pick";
import type { Quality } from "./quality";
import { withParameter } from "./sea/sea_state";
import { isIndoors, viewOf } from "./settings/surroundings";
import { Sky } from "./sky";
import { StreamedFrames } from "./streamed_frames";
import { kinds } from "./whitewater/diffuse_particles";
import { makeWhitewaterPasses, type WhitewaterPasses } from "./whitewater/whitewater";

/** Room for waves above the water in a view, as a share of its side. */
const kWaveRoom = 0.04;
/** Sides of the square per near plane, and sides of the square at the far plane: behind the last cell of an open sea. */
const kNearPerSide = 160;
const kFarSides = 500;

export class WaterScene {
  readonly camera = new PerspectiveCamera(47, 1, 0.1, 1000);
  /** Hour and weather of the light. */
  readonly daylight = new Daylight();
  private readonly frames: StreamedFrames;
  private readonly sky: Sky;
  private readonly noise = makeNoiseTexture();
  private readonly picture: Picture;
  private passes: readonly Pass[] = [];
  private solids: SolidsPass | undefined;
  private white: WhitewaterPasses | undefined;
  private darknessShare = 0;
  private ownerColors: ReadonlyMap<number, string> = new Map();
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

  /**
   * Builds the passes of this room and disposes those of the one before. `isSameWater`: the frames before are of the same water, perhaps
   * at another fidelity, and are shown until new ones come.
   */
  enter(greeting: GreetingInfo, isSameWater: boolean): void {
    this.leave();
    this.greeting = greeting;
    this.frames.enter(greeting.wave !== undefined, isSameWater);
    this.passes = this.makePasses(greeting);
    this.findFloor();
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
    const light = this.daylight.update(nowS);
    if (light) this.setLight(light);
    this.sky.update(renderer, nowS);
    renderer.setRenderTarget(null);
    renderer.clear();
    for (const pass of this.passes) {
      pass.draw(picture);
      drawn?.(pass);
    }
  }

  /** Takes ownership of a frame; `nowS`: client time. */
  take(frame: Frame, nowS: number): void {
    this.frames.take(frame, nowS);
    if (frame.layer === "particles") this.findFloor();
  }

  /** Sets the boats on the water. */
  setBoats(boats: readonly BoatDetail[]): void {
    if (this.greeting) this.greeting.boats = [...boats];
    this.solids?.setBoats(boats);
  }

  /** Paints boats in the colours of their owners. */
  setPeople(people: readonly PersonInfo[]): void {
    this.ownerColors = new Map(people.flatMap(({ color, boatIds }) => boatIds.map((boatId): [number, string] => [boatId, color])));
    this.solids?.setOwnerColors(this.ownerColors);
  }

  /** Returns the pose in which a boat is drawn now. The next frame overwrites it. */
  poseOf(boatId: number): BodyPose | undefined {
    return this.solids?.poseOf(boatId);
  }

  drawnBoats(): BodyPose[] {
    return this.solids?.drawnBoats() ?? [];
  }

  /** Returns how many drops, patches of foam and bubbles the page has added to the streamed water. */
  whitewaterCounts(): Record<keyof typeof kinds, number> {
    const of = (kind: keyof typeof kinds): number => this.white?.particles.countOf(kinds[kind]) ?? 0;
    return { spray: of("spray"), foam: of("foam"), bubble: of("bubble") };
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

  /** Returns the water into which the camera may dive; undefined: none is deep enough. */
  diveWater(): DiveWater | undefined {
    return this.greeting && diveWater(this.greeting, this.camera.near);
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
    if (this.greeting?.wind) this.greeting.wind = withParameter(this.greeting.wind, path, value);
    if (path === "storm.level_ratio") this.daylight.setRoomStorm(value);
    this.solids?.surroundings.setParameter(path, value);
  }

  /** Draws again what exists only on the GPU. */
  contextRestored(): void {
    if (this.greeting) this.enter(this.greeting, true);
  }

  dispose(): void {
    this.leave();
    this.sky.dispose();
    this.noise.dispose();
  }

  private makePasses(greeting: GreetingInfo): Pass[] {
    const { frames, sky, noise, quality } = this;
    const { wave, sideM } = greeting;
    sky.enter(isIndoors(greeting));
    this.daylight.setRoomStorm(greeting.wind?.levelRatio ?? 0, true);
    sky.hideBelowHorizon(greeting.setting === "openSea");
    const field = wave && new FieldPass(wave, frames.surfaces, quality.fieldCountMax);
    const foam = wave && greeting.layers.includes("foam") ? new FoamPass(frames.foam, wave.periodicX, wave.periodicZ) : undefined;
    const caustics = field && quality.caustics && new CausticsPass(field.texture, sky, { sideM, depthM: wave.depthM }, quality.caustics);
    const shadow = quality.shadows && new ShadowPass(greeting, sky, field?.texture, quality.shadows.texelsCount);
    const solids = (this.solids = new SolidsPass(greeting, sky, noise, field?.texture, { caustics: caustics?.uniforms, shadow: shadow?.uniforms }, frames.bodies, quality));
    shadow?.setCasters(solids);
    solids.setOwnerColors(this.ownerColors);
    solids.darkness.value = this.darknessShare;
    const { sea, glass } = solids.surroundings;
    const white = (this.white = wave && makeWhitewaterPasses(greeting, frames, solids, sky, quality.whitewater));
    const water = field && white && new WaterPass(greeting, sky, noise, field.texture, foam?.uniforms, white.froth.texture, solids, () => frames.surfaces.newest(), quality);
    const fluid = greeting.hasParticles ? makeFluidPasses(frames, solids, sky, noise, field?.texture, sideM, quality.fluid) : { before: [], after: [] };
    const flatShadow = white && !shadow ? new FlatShadowPass(solids, sky, white.froth.target, sideM) : undefined;
    const lamps = greeting.hasBoats || greeting.obstacles.length > 0 ? new LampsPass(solids, field?.texture, sideM) : undefined;
    const before = [field, caustics, foam, sea, shadow, solids, ...fluid.before, ...(white?.before ?? []), flatShadow];
    const after = [new PresentPass(sky, solids, water), ...fluid.after, ...(white?.after ?? []), lamps, glass && new GlassPass(glass)];
    const passes = [...before, water, ...after];
    return passes.filter((pass) => pass !== undefined);
  }

  /** Without a wave the lowest particles tell where the floor is. */
  private findFloor(): void {
    const frame = this.greeting?.wave ? undefined : this.frames.particles.newest();
    if (frame && frame.count > 0) this.solids?.surroundings.setFloorM(frame.minM[1] - frame.radiusM);
  }

  private setLight(light: Light): void {
    this.sky.setLight(light);
    this.darknessShare = darknessOf(light);
    if (this.solids) this.solids.darkness.value = this.darknessShare;
  }

  private leave(): void {
    for (const pass of this.passes) pass.dispose();
    this.passes = [];
    this.solids = this.white = undefined;
  }
}
