// The bar that says what the colours of a look mean: title, colours, ticks, and how its range is chosen.
import { colourMap, kColoursCount } from "../scene/looks/colour_map";
import type { Legend } from "../scene/looks/look_room";
import { byId, make, setText } from "./dom";
import { plain } from "./numbers";
import { kTexts } from "./texts";

export class LookKey {
  private readonly root = byId("look-key");
  private readonly title = make("p", { class: "key-title", "data-testid": "key-title" });
  private readonly bar = make("canvas", { width: String(kColoursCount), height: "1", "aria-hidden": "true" });
  private readonly ticks = make("ol", { class: "key-ticks", "data-testid": "key-ticks" });
  private readonly note = make("p", { class: "hint" });
  private shown = "";

  constructor() {
    this.root.append(this.title, this.bar, this.ticks, this.note);
  }

  /** Returns true if the key appeared, disappeared or changed its quantity, and with it perhaps its size. */
  show(legend: Legend | undefined): boolean {
    const wasHidden = this.root.hidden;
    this.root.hidden = !legend;
    if (!legend) return !wasHidden;
    const { quantity, range, ticks, follows } = legend;
    const what = `${quantity.look} ${quantity.map} ${range.low} ${range.high}`;
    if (what === this.shown) return wasHidden;
    const isOther = !this.shown.startsWith(`${quantity.look} `);
    this.shown = what;
    const { title } = kTexts.looks[quantity.look];
    setText(this.title, quantity.unit ? `${title} [${quantity.unit}]` : title);
    this.bar.getContext("2d")!.putImageData(new ImageData(new Uint8ClampedArray(colourMap(quantity.map)), kColoursCount, 1), 0, 0);
    this.ticks.replaceChildren(...ticks.map((value) => this.makeTick(value, (value - range.low) / (range.high - range.low))));
    setText(this.note, follows ? kTexts.rangeFollows : kTexts.rangeFixed);
    return wasHidden || isOther;
  }

  private makeTick(value: number, share: number): HTMLElement {
    const tick = make("li", {}, [plain(value)]);
    tick.style.setProperty("--at", `${100 * share}%`);
    return tick;
  }
}
