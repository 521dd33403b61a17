// The effect sliders and their commands: a splash at a place, a wave from a side.
import type { GreetingInfo } from "../codec/greeting";
import { Side } from "../gen/spindrift/v1/scene_pb";
import type { CommandAction } from "../net/messages";
import { clampTo, effectLimits, type EffectLimits } from "./effect_limits";
import { SliderRow } from "./slider_row";

type EffectKey = keyof EffectLimits;
const kKeys: EffectKey[] = ["splashRadiusM", "splashDepthM", "waveAmplitudeM", "waveLengthM"];
const kHelp: Record<EffectKey, string> = {
  splashRadiusM: "Radius of the disc that a splash pushes down.",
  splashDepthM: "How far a splash pushes the surface down.",
  waveAmplitudeM: "Height of the crest that a breaking wave starts with.",
  waveLengthM: "Width of that crest.",
};

export class EffectsPanel {
  private values: Record<EffectKey, number> | undefined;
  private readonly rows = new Map<EffectKey, SliderRow>();

  constructor(private readonly root: HTMLElement) {}

  /** Values that still fit the new room are kept. */
  enter(greeting: GreetingInfo): void {
    const limits = effectLimits(greeting);
    this.root.hidden = !limits;
    if (!limits) {
      this.values = undefined;
      return;
    }
    const before = this.values;
    this.values = { splashRadiusM: 0, splashDepthM: 0, waveAmplitudeM: 0, waveLengthM: 0 };
    for (const key of kKeys) {
      const range = limits[key];
      const value = clampTo(before?.[key] ?? range.default, range);
      this.values[key] = value;
      const row = this.rows.get(key);
      if (row) {
        row.setRange(range, value);
        continue;
      }
      const made = new SliderRow(key, range, value, kHelp[key], (moved) => {
        if (this.values) this.values[key] = moved;
      });
      this.rows.set(key, made);
      this.root.append(made.element);
    }
  }

  get available(): boolean {
    return this.values !== undefined;
  }

  splashAt(xM: number, zM: number): CommandAction | undefined {
    if (!this.values) return undefined;
    const { splashRadiusM: radiusM, splashDepthM: depthM } = this.values;
    return { case: "splash", value: { xM, zM, radiusM, depthM } };
  }

  breakingWave(): CommandAction | undefined {
    if (!this.values) return undefined;
    const { waveAmplitudeM: amplitudeM, waveLengthM: lengthM } = this.values;
    return { case: "breakingWave", value: { side: Side.PLUS_X, amplitudeM, lengthM } };
  }
}
