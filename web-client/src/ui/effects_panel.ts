// The effect sliders, the buttons for a splash and a wave, and the commands that they send.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { SideName } from "../../client/codec/scene_info";
import { Side, WaveShape } from "../../client/gen/spindrift/v1/scene_pb";
import type { CommandAction } from "../../client/session/events";
import { byId } from "./dom";
import { effectLimits, keptValue, type EffectLimits } from "./effect_limits";
import { SelectRow, type Choice } from "./select_row";
import { sidesOf } from "./side_names";
import { SliderRow } from "./slider_row";
import { kTexts } from "./texts";
import { splashOf, type ToolScale, type WaterPlace } from "./tools";

type EffectKey = keyof EffectLimits;
const kKeys: EffectKey[] = ["splashRadiusM", "splashDepthM", "waveAmplitudeM", "waveLengthM", "waveDirectionDeg"];
const kRows: Record<EffectKey, { label: string; help: string }> = {
  splashRadiusM: kTexts.splashRadius,
  splashDepthM: kTexts.splashDepth,
  waveAmplitudeM: kTexts.waveHeight,
  waveLengthM: kTexts.waveLength,
  waveDirectionDeg: kTexts.waveDirection,
};
/** The server decides. */
const kOpenSide: Choice = { value: String(Side.UNSPECIFIED), label: kTexts.openSide };
const kDirection: Choice = { value: String(Side.DIRECTION), label: kTexts.direction };
const kSides: Record<SideName, Side> = { "+x": Side.PLUS_X, "-x": Side.MINUS_X, "+z": Side.PLUS_Z, "-z": Side.MINUS_Z };
const kShapes: readonly Choice[] = [
  { value: String(WaveShape.BREAKING), label: kTexts.shapes.breaking },
  { value: String(WaveShape.SWELL), label: kTexts.shapes.swell },
];

export class EffectsPanel {
  private limits: EffectLimits | undefined;
  private values: Record<EffectKey, number> | undefined;
  private readonly rows = new Map<EffectKey, SliderRow>();
  private readonly side = new SelectRow("wave-side", kTexts.waveFrom, () => this.showDirection());
  private readonly shape = new SelectRow("wave-shape", kTexts.waveShape, () => {});

  constructor(private readonly root: HTMLElement) {
    this.side.setChoices([kOpenSide], kOpenSide.value);
    this.shape.setChoices(kShapes, kShapes[0]!.value);
  }

  /** Keeps the values in proportion to what suits the water, within what the new room allows. */
  enter(greeting: GreetingInfo): void {
    const limitsBefore = this.limits;
    const limits = (this.limits = effectLimits(greeting));
    this.root.hidden = !limits;
    if (!limits) {
      this.values = undefined;
      return;
    }
    const sides = sidesOf(greeting).map(({ side, what, where }) => ({ value: String(kSides[side]), label: kTexts.side(what, where) }));
    this.side.setChoices([kOpenSide, ...sides, kDirection], this.side.value);
    const before = this.values;
    this.values = { splashRadiusM: 0, splashDepthM: 0, waveAmplitudeM: 0, waveLengthM: 0, waveDirectionDeg: 0 };
    for (const key of kKeys) {
      const range = limits[key];
      const value = before && limitsBefore ? keptValue(before[key], limitsBefore[key], range) : range.default;
      this.values[key] = value;
      const row = this.rows.get(key);
      if (row) {
        row.setRange({ ...range, ...kRows[key] }, value);
        continue;
      }
      const made = new SliderRow(key, { ...range, ...kRows[key] }, value, (moved) => {
        if (this.values) this.values[key] = moved;
      });
      this.rows.set(key, made);
      this.root.append(made.element);
      // Between the crest's size and its direction.
      if (key === "waveLengthM") this.root.append(this.shape.element, this.side.element);
    }
    this.showDirection();
  }

  get available(): boolean {
    return this.values !== undefined;
  }

  /** `whyNot`: why the lesson withholds an effect. */
  setEnabled(isEnabled: boolean, whyNot: (effect: "splash" | "wave") => string | undefined): void {
    for (const effect of ["splash", "wave"] as const) {
      const button = byId<HTMLButtonElement>(effect);
      button.title = whyNot(effect) ?? "";
      button.disabled = !isEnabled || !this.available || button.title !== "";
    }
  }

  /** `scale`: over what the sliders say. */
  splashAt(place: WaterPlace, scale: ToolScale = { sizeRatio: 1, strengthRatio: 1 }): CommandAction | undefined {
    return this.values && this.limits && splashOf(place, this.values, this.limits, scale);
  }

  /** Radius of a splash [m]. */
  get splashRadiusM(): number {
    return this.values?.splashRadiusM ?? 0;
  }

  breakingWave(): CommandAction | undefined {
    if (!this.values) return undefined;
    const { waveAmplitudeM: amplitudeM, waveLengthM: lengthM, waveDirectionDeg: directionDeg } = this.values;
    const side = Number(this.side.value) as Side;
    const shape = Number(this.shape.value) as WaveShape;
    return { case: "breakingWave", value: { ...(side === Side.UNSPECIFIED ? {} : { side }), shape, amplitudeM, lengthM, ...(side === Side.DIRECTION ? { directionDeg } : {}) } };
  }

  private showDirection(): void {
    const row = this.rows.get("waveDirectionDeg");
    if (row) row.element.hidden = Number(this.side.value) !== Side.DIRECTION;
  }
}
