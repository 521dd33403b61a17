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

/** Adds both rows. `first`: chosen at the beginning. `chosen` gets what the address has to say then, undefined for automatic. */
export function addLightRows(daylight: Daylight, first: PresetName | number, chosen: (light: string | undefined) => void): void {
  const select = new SelectRow("light", kTexts.light, (name) => {
    if (!isPreset(name)) return;
    hour.show(daylight.choose(name), "");
    chosen(name === "automatic" ? undefined : name.replaceAll(" ", "-"));
  });
  const hour = new SliderRow("hour", { ...kTexts.hour, unit: "h", min: 0, max: 24, step: 0.25 }, 12, (value) => {
    daylight.chooseHour(value);
    select.value = kByHour;
    chosen(String(value));
  });
  const isHour = typeof first === "number";
  select.setChoices([...kPresetNames.map((name) => ({ value: name as string, label: kTexts.lights[name] })), { value: kByHour, label: kTexts.byHour }], isHour ? kByHour : first);
  if (isHour) daylight.chooseHour(first);
  hour.show(isHour ? first : daylight.choose(first), "");
  byId("light-rows").append(select.element, hour.element);
}
