// Sound in the panel: its volume, the wave tone, and whether devices vibrate. The button for sound is beside the panel.
import { kOctavesM } from "../sound/wave_tone";
import { byId, make, setText } from "./dom";
import { keepChoice, keptChoice } from "./kept";
import { SelectRow } from "./select_row";
import { SliderRow } from "./slider_row";
import { kTexts } from "./texts";

const kVolumeKey = "volume";
const kVolumeRange = { ...kTexts.volume, unit: "%", min: 0, max: 100, step: 5 };
const kDefaultPercent = 70;
const kNoTone = "";
/** Value of the middle of the view; gauges have no name with a space. */
const kMiddle = "the middle";

export class SoundRows {
  /** What the tone reads: the middle of the view, a gauge, or undefined for no tone. */
  tone: { gauge: string | undefined } | undefined;
  octaveM = 0.2;
  private readonly toneRow: SelectRow;
  private readonly octaveRow: SelectRow;
  private readonly remark = make("p", { class: "hint", "data-testid": "sound-remark" });
  private volumePercent = Number(keptChoice(kVolumeKey) ?? kDefaultPercent);
  private isWaiting = false;

  /** `changed`: volume, tone or its range. `vibration`: whether the user wants it. */
  constructor(changed: () => void, vibration: { wanted: boolean }) {
    if (!(this.volumePercent >= 0 && this.volumePercent <= 100)) this.volumePercent = kDefaultPercent;
    const volume = new SliderRow("volume", kVolumeRange, this.volumePercent, (percent) => {
      this.volumePercent = percent;
      keepChoice(kVolumeKey, String(percent));
      changed();
    });
    this.toneRow = new SelectRow("tone", kTexts.tone, (value) => {
      this.tone = value === kNoTone ? undefined : { gauge: value === kMiddle ? undefined : value };
      this.show();
      changed();
    });
    this.octaveRow = new SelectRow("tone-octave", kTexts.toneRange, (value) => {
      this.octaveM = Number(value);
      changed();
    });
    const felt = new SelectRow("vibration", kTexts.vibration, (value) => (vibration.wanted = value === "on"));
    felt.setChoices((["on", "off"] as const).map((value) => ({ value, label: kTexts[value] })), vibration.wanted ? "on" : "off");
    byId("sound-rows").append(volume.element, this.toneRow.element, this.octaveRow.element, this.remark, felt.element);
    this.show();
  }

  /** 0 to 1, as a gain: the ear hears steps of it as even. */
  get volume(): number {
    return (this.volumePercent / 100) ** 2;
  }

  /** `gauges`: names; undefined without a wave. `octaveM`: what suits the water. */
  enter(gauges: readonly string[] | undefined, octaveM: number): void {
    const chosen = this.tone?.gauge ?? (this.tone ? kMiddle : kNoTone);
    const names = [kNoTone, kMiddle, ...(gauges ?? [])];
    const kept = gauges && names.includes(chosen) ? chosen : kNoTone;
    if (kept === kNoTone) this.tone = undefined;
    this.toneRow.element.hidden = gauges === undefined;
    this.toneRow.setChoices(names.map((name) => ({ value: name, label: name === kNoTone ? kTexts.none : name === kMiddle ? kTexts.toneMiddle : kTexts.toneGauge(name) })), kept);
    this.octaveM = octaveM;
    this.octaveRow.setChoices(kOctavesM.map((eachM) => ({ value: String(eachM), label: kTexts.octave(eachM) })), String(octaveM));
    this.show();
  }

  /** `isWaiting`: the browser allows no sound yet. */
  setWaiting(isWaiting: boolean): void {
    if (isWaiting === this.isWaiting) return;
    this.isWaiting = isWaiting;
    this.show();
  }

  private show(): void {
    this.octaveRow.element.hidden = this.tone === undefined;
    setText(this.remark, [...(this.tone ? [kTexts.toneRest] : []), ...(this.isWaiting ? [kTexts.soundWaits] : [])].join(" "));
    this.remark.hidden = this.remark.textContent === "";
  }
}
