// Chooses the light: a preset, or an hour of the day. Of this page only.
import { kPresetNames, type Daylight, type PresetName } from "../scene/light/daylight";
import { byId } from "./dom";
import { SelectRow } from "./select_row";
import { SliderRow } from "./slider_row";
import { kTexts } from "./texts";

/** Shown after the slider was moved. */
const kByHour = "hour";

function isPreset(name: string): name is PresetName {
  return (kPresetNames as readonly string[]).includes(name);
}

/** Light of an address: `?light=golden-hour`, or an hour as in `?light=17.5`; anything else is automatic. */
export function lightOf(search: string): PresetName | number {
  const wanted = new URLSearchParams(search).get("light") ?? "";
  const hour = /^\d+(\.\d+)?$/.test(wanted) ? Number(wanted) : NaN;
  if (hour <= 24) return hour;
  const name = wanted.replace(/[-_]/g, " ");
  return isPreset(name) ? name : "automatic";
}

export class LightRows {
  private readonly hourRow: SliderRow;

  /** `first`: chosen at the beginning. `chosen` gets what the address has to say then, undefined for automatic. */
  constructor(private readonly daylight: Daylight, first: PresetName | number, chosen: (light: string | undefined) => void) {
    const select = new SelectRow("light", kTexts.light, (name) => {
      if (!isPreset(name)) return;
      daylight.choose(name);
      this.showHour();
      chosen(name === "automatic" ? undefined : name.replaceAll(" ", "-"));
    });
    const isHour = typeof first === "number";
    select.setChoices([...kPresetNames.map((name) => ({ value: name as string, label: kTexts.lights[name] })), { value: kByHour, label: kTexts.byHour }], isHour ? kByHour : first);
    if (isHour) daylight.chooseHour(first);
    else daylight.choose(first);
    this.hourRow = new SliderRow("hour", { ...kTexts.hour, unit: "h", min: 0, max: 24, step: 0.25 }, daylight.hour, (value) => {
      daylight.chooseHour(value);
      select.value = kByHour;
      chosen(String(value));
    });
    byId("light-rows").append(select.element, this.hourRow.element);
  }

  /** Shows the hour that is chosen; again in a scene with another one of its own. */
  showHour(): void {
    this.hourRow.show(this.daylight.hour, "");
  }
}
