// Draws everything of one room. Order of a picture: field pass → sky, floor and solids into a linear target → the water to the canvas,
// which reads that target for refraction → the target to the canvas where there is no water → the particles' liquid (fluid.ts).
import {
  DepthTexture,
  HalfFloatType,
  PerspectiveCamera,
  Scene,
  UnsignedIntType,
  Vector2,
  Vector3,
  WebGLRenderTarget,
  type RawShaderMaterial,
  type WebGLRenderer,
} from "three";

import { kMaxResolutionCount } from "../codec/frame_types";
import type { BoatDetail, GreetingInfo } from "../codec/greeting";
import type { FoamFrame, Frame, ParticleFrame, SurfaceFrame } from "../net/messages";
import { unpackBodies, type BodiesState, type BodyPose } from "./bodies";
import { Boats } from "./boats";
import { FieldPass } from "./field_pass";
import { Fluid } from "./fluid";
import { FoamField } from "./foam_field";
import { FrameRing } from "./frame_ring";
import { FullscreenPass } from "./fullscreen";
import type { ViewedBox } from "./framing";
import { elevationAtM, elevationRangeM } from "./height_field";
import { makeNoiseTexture } from "./noise_texture";
import { PlayoutClock } from "./playout_clock";
import type { WaterShape } from "./pick";
import type { Quality } from "./quality";
import { makeMaterial } from "./shaders";
import { hazeM, isIndoors, Surroundings, viewOf } from "./settings/surroundings";
import { Sky } from "./sky";
import { bedOf, type Bed } from "./terrain";
import { WaterBody } from "./water_body";

/** The four frames around the time shown, and one that came early. */
const kRingCount = 5;
/** Particles are extrapolated for at most this many frame intervals. */
const kMaxAdvanceIntervals = 1.5;
/** Room for waves above the water in a view, as a share of its side. */
const kWaveRoom = 0.04;
/** The far plane in sides of the square: behind the last cell of an open sea. */
const kFarSides = 500;

/** The water reflects solids as well as the sky. */
function hasSolids({ hasBoats, obstacles, beaches, setting }: GreetingInfo): boolean {
  return hasBoats || obstacles.length > 0 || beaches.length > 0 || setting === "pool";
}

export class WaterScene {
  readonly camera = new PerspectiveCamera(47, 1, 0.1, 1000);
  readonly clock = new PlayoutClock();
  private readonly sky: Sky;
  private readonly solids = new Scene();
  private readonly waters = new Scene();
  private readonly surfaces: FrameRing<SurfaceFrame>;
  private readonly particleFrames: FrameRing<ParticleFrame>;
  private readonly foamFrames: FrameRing<FoamFrame>;
  private readonly bodyStates = new FrameRing<BodiesState>(kRingCount, () => {});
  private readonly present: FullscreenPass;
  private readonly noise = makeNoiseTexture();
  private behind: WebGLRenderTarget;
  private field: FieldPass | undefined;
  private body: WaterBody | undefined;
  private surroundings: Surroundings | undefined;
  private fluid: Fluid | undefined;
  private foam: FoamField | undefined;
  private solid: RawShaderMaterial | undefined;
  private boats: Boats | undefined;
  private greeting: GreetingInfo | undefined;
  private readonly size = new Vector2();

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly quality: Quality,
    private readonly release: (frame: Frame) => void,
  ) {
    this.surfaces = new FrameRing<SurfaceFrame>(kRingCount, release);
    this.particleFrames = new FrameRing<ParticleFrame>(kRingCount, release);
    this.foamFrames = new FrameRing<FoamFrame>(kRingCount, release);
    this.sky = new Sky(quality.samplesCount > 1);
    this.present = new FullscreenPass(
      makeMaterial("present", { ...this.sky.uniforms, u_behind: { value: null } }, { depthWrite: false }),
    );
    renderer.autoClear = false;
    this.behind = this.makeBehind(1, 1);
    this.solids.add(this.sky.dome);
    this.sky.bake(renderer, false);
  }

  /** Builds the parts of this room and disposes those of the one before. */
  enter(greeting: GreetingInfo): void {
    this.leave();
    this.greeting = greeting;
    const { wave, sideM } = greeting;
    if (wave) {
      const resolutionCount = Math.min(Math.max(wave.resolutionCount, 2), kMaxResolutionCount);
      this.field = new FieldPass(resolutionCount, this.quality.fieldCountMax, sideM, wave.periodicX, wave.periodicZ);
      this.field.renderStill(this.renderer);
      if (greeting.layers.includes("foam")) this.foam = new FoamField(wave.periodicX, wave.periodicZ);
    }
    this.sky.bake(this.renderer, isIndoors(greeting));
    this.sky.hideBelowHorizon(greeting.setting === "openSea");
    this.enterSolids(greeting, bedOf(greeting));
    if (this.field) {
      const { edge } = this.surroundings!;
      this.body = new WaterBody(this.sky, this.field.texture, this.behindTextures(), bedOf(greeting), this.noise, this.foam?.uniforms, hasSolids(greeting), edge, this.quality);
      this.waters.add(this.body.group);
    }
    if (greeting.hasParticles) this.fluid = new Fluid(this.sky, this.noise, this.field?.texture, sideM, this.quality.fluid);
    this.camera.near = sideM / 160;
    this.camera.far = sideM * kFarSides;
    this.camera.updateProjectionMatrix();
  }

  /** Sets the boats on the water. */
  setBoats(boats: readonly BoatDetail[]): void {
    if (this.greeting) this.greeting.boats = [...boats];
    this.boats?.setBoats(boats);
  }

  /** Returns the pose in which a boat is drawn now. The next frame overwrites it. */
  poseOf(boatId: number): BodyPose | undefined {
    return this.boats?.poseOf(boatId);
  }

  drawnBoats(): BodyPose[] {
    return this.boats?.drawn() ?? [];
  }

  /** Returns the box that a view shows: the water with room for waves, or the bounds of the newest particle frame. */
  viewedBox(): ViewedBox | undefined {
    if (!this.greeting) return undefined;
    const { sideM, widthM, wave } = this.greeting;
    const view = viewOf(this.greeting);
    if (wave) return { ...view, sideM, widthM, minYM: -wave.depthM, maxYM: kWaveRoom * sideM };
    const frame = this.particleFrames.newest();
    return frame && { ...view, sideM, widthM, minYM: frame.minM[1] - frame.radiusM, maxYM: frame.maxM[1] + frame.radiusM };
  }

  /** Takes ownership of a frame; `nowS`: client time. */
  take(frame: Frame, nowS: number): void {
    switch (frame.layer) {
      case "surface":
        this.surfaces.push(frame);
        break;
      case "foam":
        this.foamFrames.push(frame);
        break;
      case "bodies":
        this.bodyStates.push(unpackBodies(frame));
        this.release(frame);
        break;
      case "particles":
        if (!this.greeting?.wave && frame.count > 0) this.surroundings?.setFloorM(frame.minM[1] - frame.radiusM);
        this.particleFrames.push(frame);
    }
    // Only one layer sets the clock: the layers of a tick arrive one after the other, and a late one would look like time going back.
    if (frame.layer === (this.greeting?.wave ? "surface" : "particles")) this.clock.noteFrame(frame.timeS, frame.serverTimeS, nowS);
  }

  newestSurface(): SurfaceFrame | undefined {
    return this.surfaces.newest();
  }

  /** Returns the surface for picking: the newest elevations, or flat water before the first frame. */
  shape(): WaterShape | undefined {
    if (!this.greeting) return undefined;
    const { sideM } = this.greeting;
    const frame = this.surfaces.newest();
    if (!frame) return { sideM, minM: 0, maxM: 0, elevationAtM: () => 0 };
    return { sideM, ...elevationRangeM(frame), elevationAtM: (xM, zM) => elevationAtM(frame, xM, zM) };
  }

  render(nowS: number): void {
    const { renderer, camera } = this;
    const shownS = this.clock.displayTimeS(nowS);
    if (shownS !== undefined) this.advanceTo(shownS);
    renderer.getDrawingBufferSize(this.size);
    if (this.behind.width !== this.size.x || this.behind.height !== this.size.y) {
      this.behind.dispose();
      this.behind = this.makeBehind(this.size.x, this.size.y);
    }
    camera.updateMatrixWorld();
    this.sky.follow(camera);
    this.surroundings?.look(camera.position);
    (this.solid?.uniforms["u_camera_m"]!.value as Vector3 | undefined)?.copy(camera.position);
    this.body?.update(camera.position, camera.near, camera.far, this.behindTextures(), this.size.x, this.size.y);

    renderer.setRenderTarget(this.behind);
    renderer.clear();
    renderer.render(this.solids, camera);
    if (this.surroundings) this.fluid?.renderShadow(renderer, camera, this.behind, this.surroundings.floorM);
    this.present.material.uniforms["u_behind"]!.value = this.behind.texture;
    renderer.setRenderTarget(null);
    renderer.clear();
    renderer.render(this.waters, camera);
    // After the water, so that it shades only the pixels without water.
    this.present.render(renderer, null);
    this.fluid?.render(renderer, camera, this.behindTextures());
    if (this.surroundings?.overlay) renderer.render(this.surroundings.overlay, camera);
  }

  /** Follows a parameter of the room, by its path in the scene. */
  setParameter(path: string, value: number): void {
    this.surroundings?.setParameter(path, value);
  }

  /** Draws again what exists only on the GPU. */
  contextRestored(): void {
    this.sky.bake(this.renderer, false);
    if (this.greeting) this.enter(this.greeting);
  }

  dispose(): void {
    this.leave();
    this.sky.dispose();
    this.present.dispose();
    this.noise.dispose();
    this.behind.dispose();
  }

  private advanceTo(shownS: number): void {
    this.surroundings?.prepare(this.renderer, shownS);
    const surfaces = this.surfaces.around(shownS);
    if (surfaces) this.field?.render(this.renderer, surfaces);
    const foam = this.foam && this.foamFrames.around(shownS);
    if (foam) this.foam!.show(foam.from, foam.to, foam.mix);
    const bodies = this.boats && this.bodyStates.around(shownS);
    if (bodies) this.boats!.show(bodies.from, bodies.to, bodies.mix);
    const particles = this.particleFrames.around(shownS);
    if (!particles || !this.fluid) return;
    const maxAdvanceS = kMaxAdvanceIntervals * this.clock.intervalS();
    const advanceS = Math.min(Math.max(shownS - particles.from.timeS, 0), maxAdvanceS);
    this.fluid.show(particles.from, advanceS);
  }

  private leave(): void {
    this.surfaces.clear();
    this.particleFrames.clear();
    this.foamFrames.clear();
    this.bodyStates.clear();
    this.clock.reset();
    if (this.body) this.waters.remove(this.body.group);
    if (this.surroundings) this.solids.remove(...this.surroundings.solids);
    for (const part of [this.field, this.body, this.surroundings, this.fluid, this.foam, this.boats, this.solid]) part?.dispose();
    this.field = this.body = this.surroundings = this.fluid = undefined;
    this.foam = this.boats = this.solid = undefined;
  }

  /** Boats and surroundings share one material. */
  private enterSolids(greeting: GreetingInfo, bed: Bed): void {
    const { plain } = this.quality;
    this.solid = makeMaterial(
      "solid",
      {
        ...this.sky.uniforms,
        u_camera_m: { value: new Vector3() },
        u_field: { value: this.field?.texture ?? null },
        u_noise: { value: this.noise },
        u_side_m: { value: bed.sideM },
        u_grain_m: { value: Math.min(Math.max(bed.sideM / 16, 0.5), 4) },
        u_wet_m: { value: 0.08 * bed.depthM },
        u_haze_m: { value: isIndoors(greeting) ? 0 : hazeM(greeting) },
      },
      { defines: plain ? { PLAIN: 1 } : {} },
    );
    this.surroundings = new Surroundings(greeting, { sky: this.sky, noise: this.noise, field: this.field?.texture, solid: this.solid, quality: this.quality });
    this.solids.add(...this.surroundings.solids);
    if (greeting.hasBoats) {
      this.boats = new Boats(this.solids, this.solid);
      this.boats.setBoats(greeting.boats);
    }
  }

  private behindTextures() {
    return { color: this.behind.texture, depth: this.behind.depthTexture! };
  }

  private makeBehind(widthPx: number, heightPx: number): WebGLRenderTarget {
    const samples = this.quality.samplesCount;
    const target = new WebGLRenderTarget(widthPx, heightPx, { type: HalfFloatType, samples: samples > 1 ? samples : 0 });
    target.depthTexture = new DepthTexture(widthPx, heightPx, UnsignedIntType);
    return target;
  }
}
