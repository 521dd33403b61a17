// Chooses the level of detail.
import { kLevels } from "../../client/codec/layers";
import type { DetailChoice } from "../net/messages";
import { byId } from "./dom";
import { SelectRow } from "./select_row";
import { kTexts } from "./texts";

const kChoices: { value: DetailChoice; label: string }[] = [
  { value: "auto", label: kTexts.automatic },
  ...kLevels.map(({ name }) => ({ value: name, label: kTexts.levels[name] })).reverse(),
];

export function addDetailRow(chosen: (detail: DetailChoice) => void): void {
  const row = new SelectRow("detail", kTexts.detail, (value) => chosen(value as DetailChoice));
  row.setChoices(kChoices, "auto");
  byId("detail-row").append(row.element);
}
