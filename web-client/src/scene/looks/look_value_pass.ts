// The surface's elevation or vertical velocity at full resolution and without the field's smoothing (look_value.frag). Reads the frames
// around the time shown, as the field pass chose and uploaded them. Writes the look's value, filtered linearly between samples.
import { ClampToEdgeWrapping, HalfFloatType, RedFormat, RepeatWrapping, Vector4, WebGLRenderTarget, type Texture } from "three";

import { FullscreenPass } from "../drawing/fullscreen";
import type { Pass, Picture } from "../drawing/pass";
import { makeMaterial } from "../shaders/materials";
import type { FieldPass } from "../water/field_pass";
import type { Rectangle } from "./surface_values";

export class LookValuePass implements Pass {
  readonly name = "look value";
  readonly reads = ["frames", "field"] as const;
  readonly writes = ["lookValue"] as const;
  private readonly target: WebGLRenderTarget;
  private readonly screen: FullscreenPass;

  constructor(
    private readonly field: FieldPass,
    { periodicX, periodicZ }: Rectangle,
    private readonly of: "elevation" | "rate",
  ) {
    this.target = new WebGLRenderTarget(1, 1, {
      format: RedFormat,
      type: HalfFloatType,
      wrapS: periodicX ? RepeatWrapping : ClampToEdgeWrapping,
      wrapT: periodicZ ? RepeatWrapping : ClampToEdgeWrapping,
      depthBuffer: false,
    });
    const uniforms = { ...field.frameUniforms, u_weights: { value: new Vector4() } };
    this.screen = new FullscreenPass(makeMaterial("lookValue", uniforms, { depthTest: false, depthWrite: false }));
  }

  get texture(): Texture {
    return this.target.texture;
  }

  draw({ renderer }: Picture): void {
    const { shown } = this.field;
    if (!shown) return;
    const { resolutionCount, countZ } = shown.frames[2]!;
    this.target.setSize(resolutionCount, countZ);
    const weights = this.of === "elevation" ? shown.weights : shown.ratesPerS;
    const [a, b, c, d] = shown.frames.map(({ quantumM }, i) => weights[i]! * quantumM);
    (this.screen.material.uniforms["u_weights"]!.value as Vector4).set(a!, b!, c!, d!);
    this.screen.render(renderer, this.target);
  }

  dispose(): void {
    this.target.dispose();
    this.screen.dispose();
  }
}
