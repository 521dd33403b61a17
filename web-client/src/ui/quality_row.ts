// Chooses the quality of the drawing, and names the one that is drawn.
import { kTierNames, type QualityChoice, type TierName } from "../scene/drawing/quality";
import { byId, make, setText } from "./dom";
import { SelectRow } from "./select_row";
import { kTexts } from "./texts";

export class QualityRow {
  private readonly row: SelectRow;
  private readonly remark = make("p", { class: "hint", "data-testid": "quality-remark" });

  constructor(
    private readonly isSoftwareRenderer: boolean,
    chosen: (choice: QualityChoice) => void,
  ) {
    this.row = new SelectRow("quality", kTexts.quality, (value) => chosen(value as QualityChoice));
    byId("quality-row").append(this.row.element, this.remark);
  }

  /** `resolutionShare`: of the tier's own resolution. */
  show({ tier, resolutionShare, isAutomatic }: { tier: TierName; resolutionShare: number; isAutomatic: boolean }): void {
    const automatic = { value: "automatic", label: isAutomatic ? kTexts.automaticNow(kTexts.qualities[tier]) : kTexts.automatic };
    this.row.setChoices([automatic, ...kTierNames.map((name) => ({ value: name as string, label: kTexts.qualities[name] }))], isAutomatic ? "automatic" : tier);
    const remarks = [
      ...(this.isSoftwareRenderer ? [kTexts.drawsInSoftware] : []),
      ...(resolutionShare < 1 ? [kTexts.resolutionLowered(Math.round(100 * resolutionShare))] : []),
    ];
    setText(this.remark, remarks.join(" "));
    this.remark.hidden = remarks.length === 0;
  }
}
