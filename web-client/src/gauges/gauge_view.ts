// What the page shows of gauges: their names in the picture, and a button for the panel with the chart, which is loaded when it is first
// opened. The button shows where there are gauges, or where this visitor may place one.
import type { GaugeInfo } from "../../client/codec/scene_info";
import { byId, make } from "../ui/dom";
import { kGaugeTexts } from "../ui/gauge_texts";
import type { GaugePanel, GaugeWorld } from "./gauge_panel";
import type { GaugeReadingInfo } from "./gauge_record";
import { GaugeTags } from "./gauge_tags";
import "./gauges.css";

interface ViewWorld extends GaugeWorld {
  /** Opens the panel of the page, of which the chart is a part on narrow windows. */
  openSheet(): void;
}

/** As in style.css: below this width the page's panel is a sheet. */
const kNarrow = window.matchMedia("(max-width: 760px)");

export class GaugeView {
  readonly tags = new GaugeTags(byId("view"));
  private readonly button = make("button", { type: "button", class: "primary", "data-testid": "gauges", title: kGaugeTexts.open, "aria-expanded": "false" }, [kGaugeTexts.gauges]);
  private gauges: readonly GaugeInfo[] = [];
  private loading: Promise<GaugePanel> | undefined;
  private panel: GaugePanel | undefined;

  constructor(private readonly world: ViewWorld) {
    byId("effect-buttons").append(this.button);
    this.button.addEventListener("click", () => void this.toggle());
    kNarrow.addEventListener("change", () => this.putInPlace());
  }

  /** `isOtherWater`: another room or scene. */
  setGauges(gauges: readonly GaugeInfo[], isOtherWater: boolean): void {
    this.gauges = gauges;
    this.tags.setGauges(gauges);
    this.panel?.setGauges(gauges, isOtherWater);
    this.refresh();
  }

  /** Role, people or a placing have changed. */
  refresh(): void {
    this.button.hidden = this.gauges.length === 0 && !this.world.mayPlace();
    if (this.button.hidden) this.close();
    this.panel?.refresh();
  }

  take(timeS: number, readings: readonly GaugeReadingInfo[]): void {
    this.panel?.take(timeS, readings);
  }

  private async toggle(): Promise<void> {
    if (this.panel?.isOpen) return this.close();
    try {
      const panel = await (this.loading ??= this.load());
      this.panel = panel;
      this.putInPlace();
      panel.setGauges(this.gauges, false);
      panel.open();
      this.button.setAttribute("aria-expanded", "true");
      if (kNarrow.matches) this.world.openSheet();
    } catch {
      this.loading = undefined;
      this.world.fail(kGaugeTexts.notLoaded);
    }
  }

  private async load(): Promise<GaugePanel> {
    const { GaugePanel } = await import("./gauge_panel");
    return new GaugePanel(this.world, () => this.close());
  }

  private close(): void {
    this.panel?.close();
    this.button.setAttribute("aria-expanded", "false");
  }

  private putInPlace(): void {
    if (!this.panel) return;
    if (kNarrow.matches) byId("panel-rest").prepend(this.panel.element);
    else byId("tools").before(this.panel.element);
  }
}
