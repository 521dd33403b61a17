// Chooses the light: a preset, or an hour of the day. Of this page only.
import { kPresetNames, type Daylight, type PresetName } from "../scene/light/daylight";
import { byId } from "./dom";
import { SelectRow } from "./select_row";
import { SliderRow } from "./slider_row";

/** Shown after the slider was moved. */
const kByHour = "hour";

function isPreset(name: string): name is PresetName {
  return (kPresetNames as readonly string[]).includes(name);
}

/** Adds both rows. `search`: of the page's address; `?light=dusk` chooses the first light. */
export function addLightRows(daylight: Daylight, search: string): void {
  const help = "Light on this page. Automatic: noon, darker and grey in a storm of the room.";
  const select = new SelectRow("light", "Light", help, (name) => isPreset(name) && hour.show(daylight.choose(name), ""));
  const hour = new SliderRow("hour", { label: "Hour", unit: "h", min: 0, max: 24, step: 0.25 }, 12, "Hour of the day on this page.", (value) => {
    daylight.chooseHour(value);
    select.value = kByHour;
  });
  const wanted = (new URLSearchParams(search).get("light") ?? "").replace(/[-_]/g, " ");
  const first = isPreset(wanted) ? wanted : "automatic";
  select.setChoices([...kPresetNames.map((name) => ({ value: name as string, label: name as string })), { value: kByHour, label: "by hour" }], first);
  hour.show(daylight.choose(first), "");
  byId("light-rows").append(select.element, hour.element);
}
