// Everything on the canvas: scene, camera, resolution and the loop that draws at display rate.
import { HalfFloatType, type WebGLRenderer } from "three";

import type { GreetingInfo } from "../../client/codec/greeting";
import type { FrameLayer } from "../../client/codec/layers";
import type { Frame } from "../net/messages";
import { CameraViews, type Followed } from "../scene/camera/camera_views";
import type { PixelRect } from "../scene/camera/framing";
import { kTiers, type Quality, type QualityChoice, type TexelType, type TierName } from "../scene/drawing/quality";
import { QualityGovernor } from "../scene/drawing/quality_governor";
import { WaterScene } from "../scene/water_scene";
import { DisplayLoop } from "./display_loop";
import { PageLayout } from "./page_layout";
import { nowS } from "./picture_clock";

const reducedMotion = (): boolean => window.matchMedia("(prefers-reduced-motion: reduce)").matches;

interface DisplayHooks {
  /** The frame was dropped from the ring. */
  release(frame: Frame): void;
  /** Called before each picture; returns the boat that the boat's view follows. */
  update(nowS: number): Followed | undefined;
  /** Called after each picture. */
  drawn(nowS: number): void;
  /** Called twice per second. `delayS`: age of the water shown. */
  measured(framesPerS: number, delayS: number | undefined): void;
  /** The quality of the drawing has changed by itself. */
  qualityChanged(): void;
}

export class Display {
  readonly canvas: HTMLCanvasElement;
  readonly scene: WaterScene;
  readonly views: CameraViews;
  /** The parts of the page that panels cover. */
  covered: readonly PixelRect[] = [];
  /** Chooses the frames that are taken; the others are dropped. */
  accepts: (frame: Frame) => boolean = () => true;
  private readonly governor: QualityGovernor;
  private drawnTier: TierName;
  private readonly layout: PageLayout;
  private readonly loop: DisplayLoop;
  private greeting: GreetingInfo | undefined;
  /** False until the water's height is known: without a wave it comes with the first frame of particles. */
  private isBoxKnown = true;
  private hasEntered = false;

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly qualities: { first: TierName; choice: QualityChoice; texelType: TexelType },
    private readonly hooks: DisplayHooks,
  ) {
    this.canvas = renderer.domElement;
    this.governor = new QualityGovernor(qualities.first, qualities.choice);
    this.drawnTier = this.governor.tier;
    this.scene = new WaterScene(renderer, this.qualityOf(this.drawnTier), (frame) => hooks.release(frame));
    this.views = new CameraViews(this.scene.camera, this.canvas, reducedMotion);
    this.layout = new PageLayout(() => this.frameFreePart());
    this.loop = new DisplayLoop(renderer, {
      draw: (frameMs) => {
        if (this.governor.note(frameMs)) {
          this.applyQuality();
          this.hooks.qualityChanged();
        }
        // The first frames have come while the room was built, and are taken before the next picture.
        if (this.hasEntered) this.hasEntered = false;
        else this.draw();
      },
      measured: (framesPerS) => hooks.measured(framesPerS, this.scene.clock.delayS()),
      contextRestored: () => this.scene.contextRestored(),
    });
  }

  get framesPerS(): number {
    return this.loop.framesPerS;
  }

  get pixelRatio(): number {
    return this.governor.pixelRatio(window.devicePixelRatio || 1, this.greeting?.wave === undefined && this.greeting?.hasParticles);
  }

  /** The tier that is drawn, the share of its resolution, and whether both follow the time that pictures take. */
  get quality(): { tier: TierName; resolutionShare: number; isAutomatic: boolean } {
    const { tier, resolutionShare, isAutomatic } = this.governor;
    return { tier, resolutionShare, isAutomatic };
  }

  chooseQuality(choice: QualityChoice): void {
    this.governor.choose(choice);
    this.applyQuality();
  }

  /** The part of the canvas that the panels leave free. */
  get freePart(): PixelRect {
    return this.layout.freePart();
  }

  /** The layers of frames that the room sends. */
  get layers(): FrameLayer[] {
    return (this.greeting?.layers ?? []).filter((layer) => layer !== "diagnostics");
  }

  /** `isRunning`: draws at display rate; otherwise only when draw() is called. */
  start(isRunning: boolean): void {
    this.applyQuality();
    if (isRunning) this.loop.start();
  }

  /** The camera keeps its view if only the scene's parameters changed. */
  enter(greeting: GreetingInfo): void {
    const before = this.greeting;
    const isSameWater = before?.sideM === greeting.sideM && Math.abs(before.widthM - greeting.widthM) < 0.05 * greeting.widthM && before.room === greeting.room && before.sceneName === greeting.sceneName;
    this.greeting = greeting;
    this.scene.enter(greeting, isSameWater);
    // Tanks have a resolution of their own.
    this.resize();
    if (isSameWater) return;
    this.hasEntered = true;
    const box = this.scene.viewedBox();
    this.isBoxKnown = box !== undefined;
    this.views.enter(box ?? { sideM: greeting.sideM, widthM: greeting.widthM, minYM: -0.25 * greeting.sideM, maxYM: 0 }, this.scene.diveWater());
  }

  take(frame: Frame): void {
    if (!this.accepts(frame)) return this.hooks.release(frame);
    this.scene.take(frame, nowS());
    if (this.isBoxKnown) return;
    const box = this.scene.viewedBox();
    this.isBoxKnown = box !== undefined;
    if (box) this.views.measured(box);
  }

  resize(): void {
    this.renderer.setPixelRatio(this.pixelRatio);
    this.renderer.setSize(window.innerWidth, window.innerHeight, false);
    this.frameFreePart();
  }

  /** From now on the water is seen beside this element, which lies over the right edge. */
  keepClearOf(aside: HTMLElement): void {
    this.layout.keepClearOf(aside);
  }

  private frameFreePart(): void {
    this.covered = this.layout.covered();
    this.views.resize(window.innerWidth, window.innerHeight, this.layout.freePart());
  }

  /**
   * Draws `picturesCount` pictures and returns the mean time of each pass, in ms, by its name; "read back" is what the measurement itself
   * takes per pass, and is subtracted already. The page waits after each pass until the GPU has drawn it.
   */
  passTimesMs(picturesCount: number): Record<string, number> {
    const context = this.renderer.getContext() as WebGL2RenderingContext;
    const pixel = new Uint8Array(4);
    const drawnMs = (): number => {
      this.renderer.setRenderTarget(null);
      context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, pixel);
      return performance.now();
    };
    const sumsMs = new Map<string, number>();
    const add = (name: string, ms: number): Map<string, number> => sumsMs.set(name, (sumsMs.get(name) ?? 0) + ms);
    for (let i = 0; i < picturesCount; ++i) {
      const idleMs = drawnMs();
      let beforeMs = drawnMs();
      const readBackMs = beforeMs - idleMs;
      add("read back", readBackMs);
      this.scene.render(nowS(), ({ name }) => {
        const afterMs = drawnMs();
        add(name, afterMs - beforeMs - readBackMs);
        beforeMs = afterMs;
      });
    }
    return Object.fromEntries([...sumsMs].map(([name, sumMs]) => [name, sumMs / picturesCount]));
  }

  /** Draws a picture with all pixels of the screen for `read`, which may read the canvas until it returns. */
  drawInFull(read: (canvas: HTMLCanvasElement) => void): void {
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.scene.render(nowS());
    read(this.canvas);
    this.resize();
    // A canvas is empty after it has changed its size.
    this.scene.render(nowS());
  }

  /** Draws one picture at the time of the pictures' clock. */
  draw(): void {
    const now = nowS();
    this.views.update(now, this.hooks.update(now));
    this.scene.render(now);
    this.hooks.drawn(now);
  }

  private qualityOf(tier: TierName): Quality {
    // Targets of floats cannot be counted on to have several samples per pixel and mip levels.
    return { ...kTiers[tier], texelType: kTiers[tier].plain ? this.qualities.texelType : HalfFloatType };
  }

  private applyQuality(): void {
    const { tier } = this.governor;
    document.body.classList.toggle("plain", kTiers[tier].plain);
    if (tier !== this.drawnTier) this.scene.setQuality(this.qualityOf(tier));
    this.drawnTier = tier;
    this.resize();
  }
}
