// Everything of one room as one picture: draws the passes that room_passes.ts lists, and what the page asks of them.
import { PerspectiveCamera, Vector2, type DataTexture, type WebGLRenderer } from "three";

import type { GameInfo } from "../../client/codec/game";
import type { BoatDetail, GreetingInfo } from "../../client/codec/greeting";
import type { GroundGrid } from "../../client/codec/ground";
import type { PersonInfo } from "../../client/codec/people";
import type { GaugeInfo } from "../../client/codec/scene_info";
import type { Frame, SurfaceFrame } from "../net/messages";
import { diveWater, type DiveWater } from "./camera/dive";
import type { ViewedBox } from "./camera/framing";
import type { BoatColors } from "./boats/livery";
import { makeNoiseTexture } from "./drawing/noise_texture";
import type { Pass, Picture } from "./drawing/pass";
import type { Quality } from "./drawing/quality";
import { makeWarmUp, type WarmUp } from "./drawing/warm_up";
import type { BodyPose } from "../../client/codec/bodies";
import type { FloaterPose } from "../../client/codec/floaters";
import { elevationAtM, elevationRangeM } from "./frames/height_field";
import type { Ray, WaterShape } from "./frames/pick";
import { StreamedFrames } from "./frames/streamed_frames";
import { isTank } from "./landscape/terrain";
import { Daylight } from "./light/daylight";
import { darknessOf, type Light } from "./light/light";
import { Sky } from "./light/sky";
import { LookRoom, type Legend, type Reading } from "./looks/look_room";
import { looksOf, type LookName } from "./looks/looks";
import { makeBase, makeNaturalWater, usedPasses, type RoomBase, type RoomTools, type RoomWater } from "./room_passes";
import { clamp } from "./maths/interpolate";
import { withParameter } from "./sea/sea_state";
import { ShoreWetness } from "./shore/shore_wetness";
import type { Pole } from "./solids/gauge_poles";
import { shownHeightM } from "./solids/glass_tank";
import { viewOf } from "./solids/surroundings";
import { LocalRipple } from "./water/local_ripple";
import { kinds } from "./whitewater/diffuse_particles";

/** Colours of boats in teams. */
const kTeamPaints = { red: "#e02b33", blue: "#2667e0" } as const;
/** Room for waves above the water in a view, as a share of its side. */
const kWaveRoom = 0.04;
/** Sides of the square per near plane, and sides of the square at the far plane: behind the last cell of an open sea. */
const kNearPerSide = 160;
const kFarSides = 500;
/** How far behind a finger the server's water is beyond the age of the picture, and most of both together. */
const kServerBehindS = 0.08;
const kMostBehindS = 1;

export class WaterScene {
  readonly camera = new PerspectiveCamera(47, 1, 0.1, 1000);
  /** Hour and weather of the light. */
  readonly daylight = new Daylight();
  /** The dents of one's own fingers. */
  readonly ripple = new LocalRipple();
  readonly frames: StreamedFrames;
  private sky: Sky;
  private noise: DataTexture;
  private readonly wetness = new ShoreWetness();
  private readonly picture: Picture;
  /** What every look needs: field, foam, surroundings. */
  private base: RoomBase | undefined;
  /** The water in the look shown. */
  private water: RoomWater | undefined;
  private lookRoom: LookRoom | undefined;
  /** Those of the above whose results are used, in the order in which they are drawn. */
  private passes: readonly Pass[] = [];
  private warmUp: WarmUp;
  private darknessShare = 0;
  private ownerColors: ReadonlyMap<number, BoatColors> = new Map();
  private game: { kind: GameInfo["kind"] | undefined; nextMark: number | undefined } = { kind: undefined, nextMark: undefined };
  private gauges: readonly GaugeInfo[] = [];
  private wantedLook: LookName = "natural";
  private greeting: GreetingInfo | undefined;
  /** Range of the elevations of the frame that was picked last. */
  private ranged: { frame: SurfaceFrame; range: { minM: number; maxM: number } } | undefined;

  constructor(
    private readonly renderer: WebGLRenderer,
    private quality: Quality,
    release: (frame: Frame) => void,
  ) {
    this.frames = new StreamedFrames(release);
    this.sky = new Sky(quality);
    this.noise = makeNoiseTexture(quality.plain);
    this.picture = { renderer, camera: this.camera, sizePx: new Vector2(), shownS: undefined };
    renderer.autoClear = false;
    this.warmUp = makeWarmUp(renderer, quality.plain);
  }

  get clock() {
    return this.frames.clock;
  }

  /** The simulation time of the picture drawn last [s]; it follows the newest frame after the delay of the clock. */
  get shownTimeS(): number | undefined {
    return this.picture.shownS;
  }

  /**
   * Builds the passes of this room and disposes those of the one before. `isSameWater`: the frames before are of the same water, perhaps
   * at another fidelity, and are shown until new ones come.
   */
  enter(greeting: GreetingInfo, isSameWater: boolean): void {
    this.leave();
    this.greeting = greeting;
    this.frames.enter(greeting.wave !== undefined, isSameWater);
    if (!isSameWater) this.wetness.clear();
    this.sky.enter(greeting.waterType);
    this.sky.hideBelowHorizon(greeting.setting === "openSea");
    this.daylight.setSceneHour(greeting.firstView?.hour ?? 12);
    this.daylight.setRoomStorm(greeting.wind?.levelRatio ?? 0, true);
    this.base = makeBase(greeting, this.tools);
    this.base.solids.setOwnerColors(this.ownerColors);
    this.base.solids.setGame(this.game.kind, this.game.nextMark);
    this.base.solids.setGauges(this.gauges);
    this.base.solids.darkness.value = this.darknessShare;
    this.makeWater();
    // From now on the canvas shows a picture, and most programs are known.
    this.warmUp = () => {};
    this.findFloor();
    // A long channel is looked at from as near as it is wide.
    const { sideM, widthM } = greeting;
    this.camera.near = Math.sqrt(sideM * widthM) / kNearPerSide;
    this.camera.far = Math.max(sideM, widthM) * kFarSides;
    this.camera.updateProjectionMatrix();
  }

  /** Draws the same water in another quality. */
  setQuality(quality: Quality): void {
    this.leave();
    this.sky.dispose();
    this.noise.dispose();
    this.quality = quality;
    this.sky = new Sky(quality);
    this.noise = makeNoiseTexture(quality.plain);
    if (this.greeting) this.enter(this.greeting, true);
  }

  /** Draws one picture; `drawn` is called after each pass. */
  render(nowS: number, drawn?: (pass: Pass) => void): void {
    const { renderer, camera, picture } = this;
    picture.shownS = this.clock.displayTimeS(nowS);
    this.ripple.update(nowS, clamp((this.clock.delayS() ?? 0) + kServerBehindS, kServerBehindS, kMostBehindS));
    renderer.getDrawingBufferSize(picture.sizePx);
    camera.updateMatrixWorld();
    const light = this.daylight.update(nowS);
    if (light) this.setLight(light);
    // Nor is the canvas cleared before a room is known: the browser would show the page anew, which takes long without graphics hardware.
    if (!this.base) return;
    this.sky.update(renderer, nowS);
    renderer.setRenderTarget(null);
    renderer.setClearColor(this.base.solids.backdrop, 1);
    renderer.clear();
    renderer.setClearColor(0x000000, 0);
    for (const pass of this.passes) {
      pass.draw(picture);
      drawn?.(pass);
    }
    this.lookRoom?.measure(nowS);
  }

  /** Takes over from the picture of this time, without drawing it, what later pictures need of it. */
  remember(nowS: number): void {
    this.picture.shownS = this.clock.displayTimeS(nowS);
    for (const pass of this.passes) pass.remember?.(this.picture);
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
    this.frames.take(frame, nowS);
    if (frame.layer === "particles") this.findFloor();
  }

  /** Draws the ground of the room's scene, which comes after its greeting. */
  setGround(ground: GroundGrid): void {
    if (!this.greeting) return;
    this.greeting.ground = ground;
    this.enter(this.greeting, true);
  }

  /** Sets the boats on the water. */
  setBoats(boats: readonly BoatDetail[]): void {
    if (this.greeting) this.greeting.boats = [...boats];
    this.base?.solids.setBoats(boats);
  }

  /** Sets the gauges in the water: those of the scene, and those that people have placed. */
  setGauges(gauges: readonly GaugeInfo[]): void {
    this.gauges = gauges;
    this.base?.solids.setGauges(gauges);
  }

  drawnGauges(): readonly Pole[] {
    return this.base?.solids.drawnGauges() ?? [];
  }

  /** Shows what belongs to a game, without one everything, and highlights the mark of the course that one's own boat has to round. */
  setGame(kind: GameInfo["kind"] | undefined, nextMark: number | undefined): void {
    this.game = { kind, nextMark };
    this.base?.solids.setGame(kind, nextMark);
  }

  /** Paints boats in the colours of their owners and teams. */
  setPeople(people: readonly PersonInfo[]): void {
    const colorsOf = ({ color: owner, team }: PersonInfo): BoatColors => ({ owner, team: team && kTeamPaints[team] });
    this.ownerColors = new Map(people.flatMap((person) => person.boatIds.map((boatId): [number, BoatColors] => [boatId, colorsOf(person)])));
    this.base?.solids.setOwnerColors(this.ownerColors);
  }

  /** Returns the pose in which a boat is drawn now. The next frame overwrites it. */
  poseOf(boatId: number): BodyPose | undefined {
    return this.base?.solids.poseOf(boatId);
  }

  drawnBoats(): BodyPose[] {
    return this.base?.solids.drawnBoats() ?? [];
  }

  /** Returns the objects in the water as they are drawn now. The next picture overwrites them. */
  drawnFloaters(): FloaterPose[] {
    return this.base?.solids.drawnFloaters() ?? [];
  }

  /** Returns how many drops, patches of foam, bubbles and puffs of spray the page has added to the streamed water. */
  whitewaterCounts(): Record<keyof typeof kinds, number> {
    const of = (kind: keyof typeof kinds): number => this.water?.white?.countOf(kinds[kind]) ?? 0;
    return { spray: of("spray"), foam: of("foam"), bubble: of("bubble"), puff: of("puff") };
  }

  /** Returns the box that a view shows: the water with room for waves, or the bounds of the newest particles; a scene's first view is that of resting water. */
  viewedBox(): ViewedBox | undefined {
    if (!this.greeting) return undefined;
    const { sideM, widthM, wave, firstView } = this.greeting;
    const view = viewOf(this.greeting);
    if (wave) return { ...view, sideM, widthM, minYM: -wave.depthM, maxYM: kWaveRoom * Math.sqrt(sideM * widthM) };
    const frame = this.frames.particles.newest();
    if (!frame) return undefined;
    const minYM = this.floorM()!;
    return { ...view, sideM, widthM, withFloor: isTank(this.greeting), minYM, maxYM: firstView ? minYM + shownHeightM(this.greeting) : frame.maxM[1] + frame.radiusM };
  }

  /** Returns the level of the floor: that of the wave, or below the lowest of the newest particles. */
  private floorM(): number | undefined {
    const wave = this.greeting?.wave;
    const frame = this.frames.particles.newest();
    return wave ? -wave.depthM : frame && frame.minM[1] - frame.radiusM;
  }

  /** Returns the water into which the camera may dive; undefined: none is deep enough. */
  diveWater(): DiveWater | undefined {
    return this.greeting && diveWater(this.greeting, this.camera.near);
  }

  /** Returns wetness and swash foam (0 to 1) of the ground at a position; undefined where the shore is fixed, and before the first picture. */
  shoreAt(xM: number, zM: number): { wetness: number; foam: number } | undefined {
    if (!this.greeting) return undefined;
    const { sideM, widthM } = this.greeting;
    return this.wetness.at(xM / sideM + 0.5, zM / widthM + 0.5);
  }

  newestSurface(): SurfaceFrame | undefined {
    return this.frames.surfaces.newest();
  }

  /** Returns the newest elevation; 0 before the first frame. */
  readonly heightAtM = (xM: number, zM: number): number => {
    const frame = this.newestSurface();
    return frame ? elevationAtM(frame, xM, zM) : 0;
  };

  /** Returns the surface for picking: the newest elevations, or flat water where no frame has any. */
  shape(): WaterShape | undefined {
    if (!this.greeting) return undefined;
    const { sideM, widthM, wave, waterExtents } = this.greeting;
    const floorM = this.floorM();
    const sides = { sideM, widthM, glassFromM: isTank(this.greeting) ? floorM : undefined };
    const frame = this.newestSurface();
    const restingM = wave || floorM === undefined ? 0 : floorM + waterExtents.depthM;
    if (!frame) return { ...sides, minM: restingM, maxM: restingM, elevationAtM: () => restingM };
    // A finger asks many times per frame.
    if (this.ranged?.frame !== frame) this.ranged = { frame, range: elevationRangeM(frame) };
    return { ...sides, ...this.ranged.range, elevationAtM: (xM, zM) => elevationAtM(frame, xM, zM) };
  }

  /** Follows a parameter of the room, by its path in the scene. */
  setParameter(path: string, value: number): void {
    if (this.greeting?.wind) this.greeting.wind = withParameter(this.greeting.wind, path, value);
    if (path === "wave.depth_m" && this.greeting?.wave) this.greeting.wave.depthM = this.greeting.waterExtents.depthM = value;
    if (path === "storm.level_ratio") this.daylight.setRoomStorm(value);
    this.base?.solids.surroundings.setParameter(path, value);
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

  private get tools(): RoomTools {
    const { frames, sky, noise, quality, wetness, ripple, warmUp } = this;
    return { frames, sky, noise, quality, wetness, ripple, warmUp };
  }

  private makeWater(): void {
    const { base, greeting } = this;
    if (!base || !greeting) return;
    this.leaveWater();
    if (this.look === "natural") this.water = makeNaturalWater(greeting, base, this.tools);
    else this.water = this.lookRoom = new LookRoom(this.look, greeting, { ...base, ...this.tools });
    this.daylight.holdNoon(this.lookRoom !== undefined);
    this.passes = usedPasses([...base.passes, ...this.water.passes]);
  }

  private leaveWater(): void {
    this.base?.solids.resetUse();
    this.water?.dispose();
    this.water = this.lookRoom = undefined;
    this.passes = [];
  }

  /** Without a wave the lowest particles tell where the floor is. */
  private findFloor(): void {
    const frame = this.greeting?.wave ? undefined : this.frames.particles.newest();
    if (frame && frame.count > 0) this.base?.solids.surroundings.setFloorM(frame.minM[1]);
  }

  private setLight(light: Light): void {
    this.sky.setLight(light);
    this.darknessShare = darknessOf(light);
    if (this.base) this.base.solids.darkness.value = this.darknessShare;
  }

  private leave(): void {
    this.leaveWater();
    for (const pass of this.base?.passes ?? []) pass.dispose();
    this.base = undefined;
  }
}
