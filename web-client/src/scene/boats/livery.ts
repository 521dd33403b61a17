// Paints of boats. The sides have the colour of the boat's owner, or one by the boat's number.
import type { Paint } from "../meshes/mesh_builder";
import type { HullKind } from "./lines";

export interface Livery {
  bottom: Paint;
  stripe: Paint;
  side: Paint;
  flag: Paint;
  transom: Paint;
  strake: Paint;
  gunwale: Paint;
  inside: Paint;
  deck: Paint;
  house: Paint;
  roof: Paint;
}

export const kGlass: Paint = [0.02, 0.045, 0.06, 0];
export const kMetal: Paint = [0.25, 0.27, 0.29, 0];
export const kSteel: Paint = [0.55, 0.57, 0.58, 0];
export const kBlack: Paint = [0.03, 0.032, 0.035, 0.3];
export const kCanvas: Paint = [0.62, 0.57, 0.47, 0.4];

/** Of boats without an owner; duller than the colours that the server gives to people. */
const kSideColors: readonly Paint[] = [
  [0.03, 0.07, 0.15, 0], [0.20, 0.045, 0.04, 0], [0.035, 0.105, 0.08, 0], [0.60, 0.57, 0.48, 0], [0.20, 0.22, 0.23, 0], [0.07, 0.145, 0.20, 0],
];
/** Cloth of the flag of a boat without an owner: it is seen before any hull. */
const kFlag: Paint = [0.48, 0.04, 0.035, 0.7];
/** Paint reflects less than a screen's full colour. */
const kPaintReflects = 0.8;

/** Returns the linear paint of a CSS colour "#rrggbb"; undefined for another text. */
export function paintOf(cssColor: string): Paint | undefined {
  const digits = /^#([0-9a-f]{6})$/i.exec(cssColor)?.[1];
  if (!digits) return undefined;
  const channel = (at: number): number => {
    const value = parseInt(digits.slice(at, at + 2), 16) / 255;
    return kPaintReflects * (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
  };
  return [channel(0), channel(2), channel(4), 0];
}

/** Of a boat with an owner, as CSS colours. */
export interface BoatColors {
  owner: string;
  /** Of the owner's team; undefined without one. */
  team: string | undefined;
}

/** `colors` undefined: nobody owns the boat. A team's boats have its colour all over but for stripe and roof, which are the owner's. */
export function liveryOf(kind: HullKind, boatId: number, colors: BoatColors | undefined): Livery {
  const own = (colors && paintOf(colors.owner)) || kSideColors[boatId % kSideColors.length]!;
  const side = (colors?.team && paintOf(colors.team)) || own;
  const flag: Paint = colors ? [own[0], own[1], own[2], kFlag[3]] : kFlag;
  const wood: Paint = [0.27, 0.15, 0.075, 0.3];
  const cream: Paint = [0.70, 0.67, 0.58, 0];
  const white: Paint = [0.72, 0.72, 0.69, 0];
  const common = { bottom: [0.20, 0.045, 0.035, 0] as Paint, stripe: side === own ? white : own, side, flag, transom: side, roof: side === own ? cream : own };
  if (kind === "dinghy") return { ...common, bottom: white, stripe: own, transom: side === own ? wood : own, strake: side === own ? wood : own, gunwale: wood, inside: [0.52, 0.33, 0.17, 0.3], deck: [0.46, 0.30, 0.16, 0.5], house: cream };
  if (kind === "launch") return { ...common, strake: wood, gunwale: wood, inside: cream, deck: [0.40, 0.29, 0.19, 0.4], house: white };
  return { ...common, strake: kBlack, gunwale: kBlack, inside: [0.62, 0.62, 0.58, 0], deck: [0.24, 0.30, 0.27, 0.5], house: cream };
}
