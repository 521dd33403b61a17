// Everything that is drawn of one room. A frame: field pass → sky, floor, particles into a linear target → the water to
// the canvas, reading the target for what shines through → the target where no water is.
import {
  DepthTexture,
  HalfFloatType,
  PerspectiveCamera,
  Scene,
  UnsignedIntType,
  Vector2,
  WebGLRenderTarget,
  type WebGLRenderer,
} from "three";

import type { GreetingInfo } from "../codec/greeting";
import type { Frame, ParticleFrame, SurfaceFrame } from "../net/messages";
import { FieldPass } from "./field_pass";
import { FrameRing } from "./frame_ring";
import { FullscreenPass } from "./fullscreen";
import type { WaterExtent } from "./framing";
import { Ground } from "./ground";
import { elevationAtM, elevationRangeM } from "./height_field";
import { ParticleCloud } from "./particle_cloud";
import { PlayoutClock } from "./playout_clock";
import type { WaterShape } from "./pick";
import { makeMaterial } from "./shaders";
import { Sky } from "./sky";
import { WaterBody } from "./water_body";

const kRingCount = 4;
/** Particles fly on for at most this many frame intervals; then they wait for news. */
const kMaxAdvanceIntervals = 1.5;
/** Height left for waves in a view, in sides of the water. */
const kWaveRoom = 0.04;
const kMaxResolutionCount = 4096;

export interface Quality {
  /** Cells a side of the drawn surface. */
  surfaceCellsCount: number;
  /** Samples a pixel for spheres and floor. */
  samplesCount: number;
  /** As in ChosenQuality. */
  plain: boolean;
  fieldCountMax: number;
}

export class WaterScene {
  readonly camera = new PerspectiveCamera(47, 1, 0.1, 1000);
  readonly clock = new PlayoutClock();
  private readonly sky: Sky;
  private readonly solids = new Scene();
  private readonly waters = new Scene();
  private readonly surfaces: FrameRing<SurfaceFrame>;
  private readonly particleFrames: FrameRing<ParticleFrame>;
  private readonly present: FullscreenPass;
  private behind: WebGLRenderTarget;
  private field: FieldPass | undefined;
  private body: WaterBody | undefined;
  private ground: Ground | undefined;
  private cloud: ParticleCloud | undefined;
  private greeting: GreetingInfo | undefined;
  private readonly size = new Vector2();

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly quality: Quality,
    private readonly release: (frame: Frame) => void,
  ) {
    this.surfaces = new FrameRing<SurfaceFrame>(kRingCount, release);
    this.particleFrames = new FrameRing<ParticleFrame>(kRingCount, release);
    this.sky = new Sky(quality.samplesCount > 1);
    this.present = new FullscreenPass(
      makeMaterial("present", { ...this.sky.uniforms, u_behind: { value: null } }, { depthWrite: false }),
    );
    renderer.autoClear = false;
    this.behind = this.makeBehind(1, 1);
    this.solids.add(this.sky.dome);
    this.sky.bake(renderer);
  }

  /** Builds what this room has; an earlier room's is thrown away. */
  enter(greeting: GreetingInfo): void {
    this.leave();
    this.greeting = greeting;
    const { wave, sideM } = greeting;
    const depthM = wave?.depthM ?? 1;
    if (wave) {
      const resolutionCount = Math.min(Math.max(wave.resolutionCount, 2), kMaxResolutionCount);
      this.field = new FieldPass(resolutionCount, Math.min(resolutionCount, this.quality.fieldCountMax), sideM, wave.periodicX, wave.periodicZ);
      this.field.renderStill(this.renderer);
      this.body = new WaterBody(this.sky, this.field.texture, this.behindTextures(), sideM, depthM, this.quality);
      this.waters.add(this.body.group);
    }
    this.ground = new Ground(this.sky, this.field?.texture, sideM, depthM, this.quality.plain);
    this.solids.add(this.ground.mesh);
    if (greeting.hasParticles) {
      this.cloud = new ParticleCloud(this.sky, this.field?.texture, sideM, depthM, this.quality);
      this.solids.add(this.cloud.mesh);
    }
    this.camera.near = sideM / 160;
    this.camera.far = sideM * 45;
    this.camera.updateProjectionMatrix();
  }

  /** What a view has to show: the water with room for its waves, or the particles of the newest frame. */
  extent(): WaterExtent | undefined {
    if (!this.greeting) return undefined;
    const { sideM, wave } = this.greeting;
    if (wave) return { sideM, minYM: -wave.depthM, maxYM: kWaveRoom * sideM };
    const frame = this.particleFrames.newest();
    return frame && { sideM, minYM: frame.minM[1] - frame.radiusM, maxYM: frame.maxM[1] + frame.radiusM };
  }

  /** Takes over a frame; `nowS` is the client's clock. */
  take(frame: Frame, nowS: number): void {
    if (frame.layer === "surface") this.surfaces.push(frame);
    else if (frame.layer !== "particles") this.release(frame);
    else {
      if (!this.greeting?.wave) this.ground?.lowerTo(frame.minM[1] - frame.radiusM);
      this.particleFrames.push(frame);
    }
    this.clock.noteFrame(frame.timeS, nowS);
  }

  newestSurface(): SurfaceFrame | undefined {
    return this.surfaces.newest();
  }

  /** The water as a click sees it: the newest elevations, flat before the first ones. */
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
    this.ground?.update(camera.position);
    this.cloud?.update(camera, this.size.x, this.size.y);
    this.body?.update(camera.position, camera.near, camera.far, this.behindTextures(), this.size.x, this.size.y);

    renderer.setRenderTarget(this.behind);
    renderer.clear();
    renderer.render(this.solids, camera);
    this.present.material.uniforms["u_behind"]!.value = this.behind.texture;
    renderer.setRenderTarget(null);
    renderer.clear();
    renderer.render(this.waters, camera);
    // Last, so that only pixels without water are shaded.
    this.present.render(renderer, null);
  }

  /** What lives only on the GPU is drawn again. */
  contextRestored(): void {
    this.sky.bake(this.renderer);
    if (this.greeting) this.enter(this.greeting);
  }

  dispose(): void {
    this.leave();
    this.sky.dispose();
    this.present.dispose();
    this.behind.dispose();
  }

  private advanceTo(shownS: number): void {
    const surfaces = this.surfaces.around(shownS);
    if (surfaces && this.field?.accepts(surfaces.from) && this.field.accepts(surfaces.to))
      this.field.render(this.renderer, surfaces.from, surfaces.to, surfaces.mix);
    const particles = this.particleFrames.around(shownS);
    if (!particles || !this.cloud) return;
    const maxAdvanceS = kMaxAdvanceIntervals * this.clock.intervalS();
    const advanceS = Math.min(Math.max(shownS - particles.from.timeS, 0), maxAdvanceS);
    this.cloud.show(particles.from, advanceS);
  }

  private leave(): void {
    this.surfaces.clear();
    this.particleFrames.clear();
    this.clock.reset();
    if (this.body) this.waters.remove(this.body.group);
    if (this.ground) this.solids.remove(this.ground.mesh);
    if (this.cloud) this.solids.remove(this.cloud.mesh);
    for (const part of [this.field, this.body, this.ground, this.cloud]) part?.dispose();
    this.field = this.body = this.ground = this.cloud = undefined;
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
