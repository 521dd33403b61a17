// The panel: open or closed, and which part of the canvas it leaves free.
import type { PixelRect } from "../scene/camera/framing";
import { byId } from "../ui/dom";

/** As in style.css: below this width the panel is a sheet at the bottom. */
const kNarrowPx = 760;

export class PageLayout {
  private readonly toggle = byId("panel-toggle");

  /** `changed`: the free part of the canvas may have changed. */
  constructor(private readonly changed: () => void) {
    this.toggle.addEventListener("click", () => {
      this.setPanelOpen(!this.isPanelOpen);
      this.changed();
    });
    this.setPanelOpen(window.innerWidth > kNarrowPx);
  }

  /** The part that card and panel leave free: beside and below them, on narrow screens between them. */
  freePart(): PixelRect {
    const isNarrow = window.innerWidth <= kNarrowPx;
    const panel = byId("panel").getBoundingClientRect();
    const card = byId("card").getBoundingClientRect();
    return {
      leftPx: 0,
      // The far side of the water looks narrow, so the card's corner may overlap the free part a little.
      topPx: isNarrow ? card.bottom : 0.7 * card.bottom,
      rightPx: this.isPanelOpen && !isNarrow ? panel.left : window.innerWidth,
      bottomPx: this.isPanelOpen && isNarrow ? panel.top : window.innerHeight,
    };
  }

  /** The parts of the page that card, panel and the buttons beside it cover. */
  covered(): PixelRect[] {
    const elements = ["card", "panel-toggle", "sound-toggle", "share-toggle", ...(this.isPanelOpen ? ["panel"] : [])];
    return elements.map((id) => {
      const { left, top, right, bottom } = byId(id).getBoundingClientRect();
      return { leftPx: left, topPx: top, rightPx: right, bottomPx: bottom };
    });
  }

  private get isPanelOpen(): boolean {
    return !document.body.classList.contains("panel-closed");
  }

  private setPanelOpen(isOpen: boolean): void {
    document.body.classList.toggle("panel-closed", !isOpen);
    this.toggle.setAttribute("aria-expanded", String(isOpen));
    this.toggle.setAttribute("aria-label", isOpen ? "Hide controls" : "Show controls");
  }
}
