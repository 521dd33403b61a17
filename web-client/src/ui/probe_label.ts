// The label of the probe: value, unit and position of the water under the pointer, the finger, or the middle of the picture.
import type { Reading } from "../scene/looks/look_room";
import { byId, formatBy, setText } from "./dom";
import { kTexts } from "./texts";

const kPlaceStepM = 0.01;
const kEdgePx = 8;
/** Distance of the label from the position: beside a pointer, above a finger. */
const kBesidePx = 14;
const kAbovePx = 48;

export interface ProbePlace {
  xPx: number;
  yPx: number;
  /** The label would be under the finger. */
  isTouch: boolean;
}

/** Returns the value with its unit, with as many decimals as the stream can tell apart. */
export function describeValue({ quantity, value, step, bound }: Pick<Reading, "quantity" | "value" | "step" | "bound">): string {
  const shortest = formatBy(Math.min(step, 1), 0);
  const number = formatBy(Math.min(step, 1), value);
  const sign = bound === "low" ? "≤ " : bound === "high" ? "≥ " : "";
  return `${sign}${number === `-${shortest}` ? shortest : number}${quantity.unit ? ` ${quantity.unit}` : ""}`;
}

/** Returns the position with its unit; the height only of particles, which lie anywhere. */
export function describePlace({ quantity, xM, yM, zM }: Pick<Reading, "quantity" | "xM" | "yM" | "zM">): string {
  const at = (valueM: number): string => formatBy(kPlaceStepM, valueM);
  return quantity.of === "particles" ? `x ${at(xM)} m, y ${at(yM)} m, z ${at(zM)} m` : `x ${at(xM)} m, z ${at(zM)} m`;
}

export class ProbeLabel {
  private readonly root = byId("probe");
  private readonly label = byId("probe-label");
  private readonly value = byId("probe-value");
  private readonly place = byId("probe-place");

  /** `reading` undefined: there is no value at the position. */
  show(reading: Reading | undefined, { xPx, yPx, isTouch }: ProbePlace): void {
    this.root.hidden = !reading;
    if (!reading) return;
    setText(this.value, describeValue(reading));
    setText(this.place, describePlace(reading));
    this.label.setAttribute("aria-label", kTexts.valueAt(kTexts.looks[reading.quantity.look].title, this.value.textContent, this.place.textContent));
    this.root.style.transform = `translate(${Math.round(xPx)}px, ${Math.round(yPx)}px)`;
    const { offsetWidth: widthPx, offsetHeight: heightPx } = this.label;
    const leftPx = isTouch ? -widthPx / 2 : xPx + kBesidePx + widthPx + kEdgePx > window.innerWidth ? -kBesidePx - widthPx : kBesidePx;
    const topPx = isTouch ? -kAbovePx - heightPx : yPx + kBesidePx + heightPx + kEdgePx > window.innerHeight ? -kBesidePx - heightPx : kBesidePx;
    const heldPx = (px: number, at: number, sizePx: number, endPx: number): number => Math.min(Math.max(at + px, kEdgePx), endPx - sizePx - kEdgePx) - at;
    this.label.style.transform = `translate(${Math.round(heldPx(leftPx, xPx, widthPx, window.innerWidth))}px, ${Math.round(heldPx(topPx, yPx, heightPx, window.innerHeight))}px)`;
  }

  hide(): void {
    this.root.hidden = true;
  }
}
