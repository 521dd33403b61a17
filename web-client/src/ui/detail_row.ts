// Chooses the level of detail.
import { kLevels } from "../codec/layers";
import type { DetailChoice } from "../net/messages";
import { byId } from "./dom";
import { SelectRow } from "./select_row";

const kChoices: { value: DetailChoice; label: string }[] = [
  { value: "auto", label: "automatic" },
  ...kLevels.map(({ name }) => ({ value: name, label: name })).reverse(),
];

export function addDetailRow(chosen: (detail: DetailChoice) => void): void {
  const help = "Level of detail that this page gets. Automatic: the finest that the link and this device can carry.";
  const row = new SelectRow("detail", "Detail", help, (value) => chosen(value as DetailChoice));
  row.setChoices(kChoices, "auto");
  byId("detail-row").append(row.element);
}
