// How much of the water the page asks for.
import type { DetailChoice } from "../net/messages";
import { byId } from "./dom";
import { SelectRow } from "./select_row";

const kChoices: { value: DetailChoice; label: string }[] = [
  { value: "auto", label: "automatic" },
  { value: "full", label: "full" },
  { value: "fine", label: "fine" },
  { value: "medium", label: "medium" },
  { value: "coarse", label: "coarse" },
];

export function addDetailRow(chosen: (detail: DetailChoice) => void): void {
  const help = "How much of the water this page is sent; automatic takes what link and device can carry.";
  const row = new SelectRow("detail", "Detail", help, (value) => chosen(value as DetailChoice));
  row.setChoices(kChoices, "auto");
  byId("detail-row").append(row.element);
}
