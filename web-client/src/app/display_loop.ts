// Draws at display rate and measures it. Pauses while the graphics context is lost.
import type { WebGLRenderer } from "three";

import { showNotice } from "../ui/notice";
import { kTexts } from "../ui/texts";

const kMeasureEveryMs = 500;

interface LoopHooks {
  /** Draws one picture; `frameMs`: time since the one before. */
  draw(frameMs: number): void;
  measured(framesPerS: number): void;
  contextRestored(): void;
}

export class DisplayLoop {
  framesPerS = 0;
  private isContextLost = false;
  private lastFrameMs = performance.now();
  private measuredSinceMs = this.lastFrameMs;
  private frameCount = 0;

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly hooks: LoopHooks,
  ) {
    renderer.domElement.addEventListener("webglcontextlost", () => {
      this.isContextLost = true;
      showNotice(kTexts.contextLost);
    });
    renderer.domElement.addEventListener("webglcontextrestored", () => {
      this.isContextLost = false;
      hooks.contextRestored();
      showNotice("");
    });
  }

  start(): void {
    this.renderer.setAnimationLoop(() => this.frame());
  }

  private frame(): void {
    if (this.isContextLost) return;
    const frameMs = performance.now() - this.lastFrameMs;
    this.lastFrameMs += frameMs;
    this.hooks.draw(frameMs);
    ++this.frameCount;
    const elapsedMs = this.lastFrameMs - this.measuredSinceMs;
    if (elapsedMs < kMeasureEveryMs) return;
    this.framesPerS = (this.frameCount * 1000) / elapsedMs;
    this.frameCount = 0;
    this.measuredSinceMs = this.lastFrameMs;
    this.hooks.measured(this.framesPerS);
  }
}
