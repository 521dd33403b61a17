// The panel on narrow screens: a sheet at the lower edge that is dragged or tapped up and down by its handle.

/** A shorter move is a tap. */
const kTapPx = 8;
/** A faster flick [px/s] moves the sheet whatever its height. */
const kFlickPxPerS = 400;

interface SheetWorld {
  /** False where the panel stands beside the water: a drag does nothing. */
  isSheet(): boolean;
  isOpen(): boolean;
  /** The finger has let go: the sheet is to be open or not. */
  settle(isOpen: boolean): void;
}

export class Sheet {
  /** While a finger drags it. */
  isDragged = false;
  private drag: { pointerId: number; beginYPx: number; beginPx: number; lowestPx: number; yPx: number; atMs: number; speedPxPerS: number } | undefined;
  private wasDragged = false;

  constructor(
    private readonly handle: HTMLElement,
    private readonly panel: HTMLElement,
    private readonly world: SheetWorld,
  ) {
    handle.addEventListener("pointerdown", (event) => this.begin(event));
    handle.addEventListener("pointermove", (event) => this.move(event));
    for (const type of ["pointerup", "pointercancel"] as const) handle.addEventListener(type, (event) => this.end(event));
    // A click that ends a drag does not count.
    handle.addEventListener("click", (event) => this.wasDragged && event.stopImmediatePropagation(), { capture: true });
  }

  private begin(event: PointerEvent): void {
    this.wasDragged = false;
    if (!this.world.isSheet() || event.button !== 0) return;
    this.handle.setPointerCapture(event.pointerId);
    const { clientY: yPx, timeStamp: atMs, pointerId } = event;
    const heightPx = this.panel.offsetHeight;
    this.drag = { pointerId, beginYPx: yPx, beginPx: heightPx, lowestPx: this.world.isOpen() ? 0 : heightPx, yPx, atMs, speedPxPerS: 0 };
  }

  private move({ pointerId, clientY: yPx, timeStamp: atMs }: PointerEvent): void {
    const { drag } = this;
    if (!drag || pointerId !== drag.pointerId) return;
    if (!this.isDragged && Math.abs(yPx - drag.beginYPx) < kTapPx) return;
    this.isDragged = this.wasDragged = true;
    // All of it shows under the finger.
    document.body.classList.remove("panel-closed");
    this.panel.style.height = `${Math.max(drag.beginPx + drag.beginYPx - yPx, drag.lowestPx)}px`;
    if (atMs > drag.atMs) drag.speedPxPerS = (1000 * (drag.yPx - yPx)) / (atMs - drag.atMs);
    Object.assign(drag, { yPx, atMs });
  }

  private end({ pointerId, type }: PointerEvent): void {
    const { drag } = this;
    if (!drag || pointerId !== drag.pointerId) return;
    this.drag = undefined;
    if (!this.isDragged) return;
    this.isDragged = false;
    const heightPx = this.panel.offsetHeight;
    this.panel.style.height = "";
    const isFlick = type === "pointerup" && Math.abs(drag.speedPxPerS) > kFlickPxPerS;
    const openPx = this.panel.offsetHeight;
    this.world.settle(isFlick ? drag.speedPxPerS > 0 : heightPx > openPx / 2);
  }
}
