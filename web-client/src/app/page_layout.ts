// The panel: open or closed, and which part of the canvas it leaves free. On narrow screens it is a sheet at the lower edge, of which the
// handle and what one does most stay when it is closed.
import type { PixelRect } from "../scene/camera/framing";
import { byId } from "../ui/dom";
import { Sheet } from "./sheet";
import { kTexts } from "../ui/texts";

/** As in style.css: below this width the panel is a sheet at the bottom. */
const kNarrowPx = 760;
/** In a lower window the panel would cover most of the water, so it is closed at first. */
const kLowPx = 480;

const isNarrow = (): boolean => window.innerWidth <= kNarrowPx;

export class PageLayout {
  private readonly toggle = byId("panel-toggle");
  private readonly panel = byId("panel");
  private readonly sheet: Sheet;
  /** Lies over the right edge of the water. */
  private aside: HTMLElement | undefined;

  /** `changed`: the free part of the canvas may have changed. */
  constructor(private readonly changed: () => void) {
    this.sheet = new Sheet(this.toggle, this.panel, {
      isSheet: isNarrow,
      isOpen: () => this.isPanelOpen,
      settle: (isOpen) => {
        this.setPanelOpen(isOpen);
        this.changed();
      },
    });
    this.toggle.addEventListener("click", () => {
      this.setPanelOpen(!this.isPanelOpen);
      this.changed();
    });
    this.setPanelOpen(!isNarrow() && window.innerHeight > kLowPx);
    // What floats over the sheet keeps its distance; the height follows from what the scene and the role allow.
    new ResizeObserver(() => {
      document.documentElement.style.setProperty("--sheet", `${this.panel.offsetHeight}px`);
      if (isNarrow() && !this.sheet.isDragged) this.changed();
    }).observe(this.panel);
  }

  /** From now on the free part ends at this element's left edge. */
  keepClearOf(aside: HTMLElement): void {
    this.aside = aside;
    new ResizeObserver(() => this.changed()).observe(aside);
  }

  /** The part that card, panel and the buttons beside it leave free: beside and below them, on narrow screens between them. */
  freePart(): PixelRect {
    const panel = this.panel.getBoundingClientRect();
    const card = byId("card").getBoundingClientRect();
    const buttons = byId("actions").getBoundingClientRect();
    const isShown = panel.height > 0;
    const aside = this.aside?.getBoundingClientRect();
    const endPx = isShown && !isNarrow() ? (buttons.width > 0 ? buttons : panel).left : window.innerWidth;
    return {
      leftPx: 0,
      // The far side of the water looks narrow, so the card's corner may overlap the free part a little.
      topPx: isNarrow() ? card.bottom : 0.7 * card.bottom,
      rightPx: aside && aside.width > 0 ? Math.min(endPx, aside.left) : endPx,
      bottomPx: isShown && isNarrow() ? panel.top : window.innerHeight,
    };
  }

  /** The parts of the page that card, panel and the buttons beside it cover. */
  covered(): PixelRect[] {
    return ["card", "actions", "panel"].map((id) => {
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
    this.toggle.setAttribute("aria-label", isOpen ? kTexts.hideControls : kTexts.showControls);
  }
}
