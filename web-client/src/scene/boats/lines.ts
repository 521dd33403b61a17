// The lines plan of a boat: keel, sheer, half breadths and profile as functions of the position along the hull, all from the hull's length,
// beam, height and draught. The keel touches half the height below the origin, the deck's lowest point half the height above it; the
// widest section has the beam, and the hull reaches from transom to stem over the length. Bow along +x, starboard +z. Pure.
import type { BoatDetail } from "../../../client/codec/greeting";
import { clamp, smooth } from "../maths/interpolate";
import type { Point } from "../meshes/mesh_builder";

export type HullKind = "dinghy" | "launch" | "cutter";

/** Hulls shorter than the first are dinghies, shorter than the second launches. [m] */
const kLaunchFromM = 2.3;
const kCutterFromM = 2.7;

interface HullForm {
  /** Position of the greatest beam, 0 at the transom, 1 at the stem. */
  widestAt: number;
  /** Breadth of the transom, as a share of the beam. */
  transom: number;
  /** Exponent of the outline ahead of the widest section: the larger, the fuller the bow. */
  entry: number;
  /** How far keel ends lie inside the ends of the sheer, in lengths. */
  stemRake: number;
  sternRake: number;
  /** Where the keel begins to rise toward the stem, and by how much it rises, in heights. */
  forefootFrom: number;
  forefootRise: number;
  /** Rise of the keel at the transom, in heights. */
  rocker: number;
  /** Exponent of the midship section: the larger, the harder its bilge. */
  bilge: number;
  /** Rise of the sheer at the ends, in heights. */
  bowSheer: number;
  sternSheer: number;
  /** Height of the bulwark over the deck, in heights. */
  bulwark: number;
}

const kForms: Record<HullKind, HullForm> = {
  dinghy: { widestAt: 0.44, transom: 0.7, entry: 1.85, stemRake: 0.1, sternRake: 0.03, forefootFrom: 0.4, forefootRise: 0.28, rocker: 0.16, bilge: 2.5, bowSheer: 0.34, sternSheer: 0.1, bulwark: 0 },
  launch: { widestAt: 0.4, transom: 0.86, entry: 1.9, stemRake: 0.16, sternRake: 0.02, forefootFrom: 0.5, forefootRise: 0.12, rocker: 0.04, bilge: 3, bowSheer: 0.3, sternSheer: 0.02, bulwark: 0 },
  cutter: { widestAt: 0.46, transom: 0.74, entry: 2.2, stemRake: 0.05, sternRake: 0.05, forefootFrom: 0.7, forefootRise: 0.16, rocker: 0.12, bilge: 2.8, bowSheer: 0.34, sternSheer: 0.1, bulwark: 0.14 },
};

/** The rubbing strake stands out by this share of the beam. */
const kStrakeBeams = 0.014;
/** Thickness of the sides, as a share of the beam. */
const kSideBeams = 0.034;
/** Position of the deck's and the keel's lowest points. */
export const kLowestAt = 0.36;
/** Hulls are drawn deeper by this share of their freeboard. */
const kSunkShare = 0.4;

export function hullKind({ lengthM }: Pick<BoatDetail, "lengthM">): HullKind {
  return lengthM < kLaunchFromM ? "dinghy" : lengthM < kCutterFromM ? "launch" : "cutter";
}

/** By how much deeper than it floats a boat is drawn: a light one would show its keel, as if it stood on the water. */
export function sunkM({ heightM, draughtM }: Pick<BoatDetail, "heightM" | "draughtM">): number {
  return kSunkShare * Math.max(heightM - draughtM, 0);
}

export class HullLines {
  readonly kind: HullKind;
  readonly strakeM: number;
  readonly sideM: number;
  /** Height of the still water over the middle of the hull that is drawn. */
  readonly waterlineM: number;
  readonly widestAt: number;
  private readonly form: HullForm;

  constructor(readonly boat: BoatDetail) {
    this.kind = hullKind(boat);
    this.form = kForms[this.kind];
    this.strakeM = kStrakeBeams * boat.beamM;
    this.sideM = kSideBeams * boat.beamM;
    this.waterlineM = -boat.heightM / 2 + boat.draughtM + sunkM(boat);
    this.widestAt = this.form.widestAt;
  }

  /** Height of the deck's edge. */
  deckM(along: number): number {
    const { bowSheer, sternSheer } = this.form;
    const ahead = Math.max((along - kLowestAt) / (1 - kLowestAt), 0);
    const astern = Math.max((kLowestAt - along) / kLowestAt, 0);
    return this.boat.heightM * (0.5 + bowSheer * ahead * ahead + sternSheer * astern * astern);
  }

  /** Height of the gunwale, or of the bulwark's top. */
  sheerM(along: number): number {
    return this.deckM(along) + this.form.bulwark * this.boat.heightM;
  }

  keelM(along: number): number {
    const { forefootFrom, forefootRise, rocker } = this.form;
    const ahead = Math.max((along - forefootFrom) / (1 - forefootFrom), 0);
    const astern = Math.max((0.3 - along) / 0.3, 0);
    return this.boat.heightM * (-0.5 + forefootRise * ahead ** 2.4 + rocker * astern * astern);
  }

  /** Half the breadth at the sheer, without the strake. */
  sheerHalfM(along: number): number {
    const { widestAt, transom, entry } = this.form;
    const share = along < widestAt ? 1 - (1 - transom) * (1 - along / widestAt) ** 2 : 1 - Math.min((along - widestAt) / (1 - widestAt), 1) ** entry;
    return (this.boat.beamM / 2 - this.strakeM) * share;
  }

  /** Half the breadth at a height, which is taken between keel and deck. */
  halfM(along: number, yM: number): number {
    const keelM = this.keelM(along);
    // A bulwark stands upright on the deck's edge.
    const up = clamp((yM - keelM) / (this.deckM(along) - keelM), 0, 1);
    const { bilge, widestAt } = this.form;
    const middle = Math.sqrt(1 - (1 - up) ** bilge) * (0.93 + 0.07 * up);
    // Toward the bow the sections become V-shaped with flare.
    const bow = 0.62 * up + 0.38 * up ** 2.6;
    const ahead = clamp((along - widestAt) / (1 - widestAt), 0, 1);
    const share = smooth(ahead);
    return this.sheerHalfM(along) * (middle + (bow - middle) * share);
  }

  /** Position along the hull: stem and transom lean outward with the height. */
  xM(along: number, yM: number): number {
    const { stemRake, sternRake } = this.form;
    const { lengthM, heightM } = this.boat;
    const under = 1 - clamp((yM + heightM / 2) / (this.sheerM(along) + heightM / 2), 0, 1);
    const bow = Math.max(2 * along - 1, 0) ** 2.5;
    const stern = Math.max(1 - along / 0.3, 0) ** 2;
    return lengthM * (along - 0.5 - stemRake * bow * under ** 1.3 + sternRake * stern * under);
  }

  /** A point of the outer side to starboard, `outM` outside the planking. */
  outside(along: number, yM: number, outM = 0): Point {
    const halfM = this.halfM(along, yM);
    return [this.xM(along, yM), yM, halfM + Math.min(outM, halfM)];
  }

  /** A point of the inner side to starboard. */
  inside(along: number, yM: number): Point {
    const astern = Math.max(1 - along / 0.05, 0);
    return [this.xM(along, yM) + astern * this.sideM, yM, Math.max(this.halfM(along, yM) - this.sideM, 0)];
  }
}
