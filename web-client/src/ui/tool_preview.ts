// Outlines of the tools on the water: one's own before and while it is used, and the discs of everybody's rain and calm, in their colours.
import { Matrix4, Vector4, type PerspectiveCamera } from "three";

import type { WaterPlace } from "./tools";

const kSvg = "http://www.w3.org/2000/svg";
const kCornersCount = 40;
/** Length of an arrow's head over the arrow. */
const kHeadShare = 0.25;
/** Streaks of a cloud's rain in a picture; their length, and how high they begin at most, in radii of the cloud. */
const kStreaksCount = 14;
const kStreakRadii = 0.25;
const kFallRadii = 1;

export type Outline =
  | { kind: "disc"; at: WaterPlace; radiusM: number; color: string }
  | { kind: "rain"; at: WaterPlace; radiusM: number; color: string }
  | { kind: "arc"; points: readonly (WaterPlace & { yM: number })[]; radiusM: number; color: string }
  | { kind: "paddle"; from: WaterPlace; to: WaterPlace; widthM: number; color: string };

/** A point over the water, or at a height of its own. */
type Point = WaterPlace & { aboveM?: number; yM?: number };

export class ToolPreview {
  private readonly svg = document.createElementNS(kSvg, "svg");
  private readonly paths: SVGPathElement[] = [];
  private readonly seen = new Matrix4();
  private readonly point = new Vector4();
  private readonly isStill = window.matchMedia("(prefers-reduced-motion: reduce)");

  /** `before`: the outlines lie over this element and under everything after it. */
  constructor(before: Element) {
    this.svg.setAttribute("class", "tool-preview");
    this.svg.setAttribute("aria-hidden", "true");
    this.svg.setAttribute("data-testid", "tool-preview");
    before.after(this.svg);
  }

  /** Called for each picture. */
  update(outlines: readonly Outline[], camera: PerspectiveCamera, heightAtM: (xM: number, zM: number) => number): void {
    this.seen.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    while (this.paths.length > outlines.length) this.paths.pop()!.remove();
    for (const [k, outline] of outlines.entries()) {
      const path = (this.paths[k] ??= this.svg.appendChild(document.createElementNS(kSvg, "path")));
      const lines = outline.kind === "rain" && !this.isStill.matches ? [...linesOf(outline), ...streaksOf(outline, Math.random)] : linesOf(outline);
      path.style.stroke = outline.color;
      path.setAttribute("d", lines.map((line) => this.draw(line, heightAtM)).join(""));
    }
  }

  /** A line through these points; empty where one is behind the camera. */
  private draw(line: readonly Point[], heightAtM: (xM: number, zM: number) => number): string {
    const points: string[] = [];
    for (const { xM, zM, aboveM = 0, yM = heightAtM(xM, zM) + aboveM } of line) {
      const { x, y, w } = this.point.set(xM, yM, zM, 1).applyMatrix4(this.seen);
      if (!(w > 1e-6)) return "";
      points.push(`${((0.5 + (0.5 * x) / w) * window.innerWidth).toFixed(1)} ${((0.5 - (0.5 * y) / w) * window.innerHeight).toFixed(1)}`);
    }
    return `M${points.join("L")}`;
  }
}

/** The lines of an outline, along the water. */
export function linesOf(outline: Outline): Point[][] {
  if (outline.kind === "arc") {
    const { xM, zM } = outline.points.at(-1)!;
    return [[...outline.points], ...linesOf({ ...outline, kind: "disc", at: { xM, zM } })];
  }
  if (outline.kind !== "paddle") {
    const { at, radiusM } = outline;
    const corner = (k: number): WaterPlace => {
      const angle = (2 * Math.PI * k) / kCornersCount;
      return { xM: at.xM + radiusM * Math.cos(angle), zM: at.zM + radiusM * Math.sin(angle) };
    };
    return [Array.from({ length: kCornersCount + 1 }, (_, k) => corner(k))];
  }
  const { from, to, widthM } = outline;
  const wayM = Math.hypot(to.xM - from.xM, to.zM - from.zM);
  if (wayM === 0) return [];
  const along = { xM: (to.xM - from.xM) / wayM, zM: (to.zM - from.zM) / wayM };
  const place = (backM: number, sideM: number): WaterPlace => ({ xM: to.xM - backM * along.xM - sideM * along.zM, zM: to.zM - backM * along.zM + sideM * along.xM });
  const headM = kHeadShare * wayM;
  return [[place(0, -widthM / 2), place(0, widthM / 2)], [from, to], [place(headM, -headM / 2), to, place(headM, headM / 2)]];
}

/** Streaks of falling rain within a cloud's disc, anew in each picture. */
export function streaksOf({ at, radiusM }: { at: WaterPlace; radiusM: number }, random: () => number): Point[][] {
  return Array.from({ length: kStreaksCount }, () => {
    const angle = 2 * Math.PI * random();
    const awayM = radiusM * Math.sqrt(random());
    const place = { xM: at.xM + awayM * Math.cos(angle), zM: at.zM + awayM * Math.sin(angle) };
    const aboveM = kFallRadii * radiusM * random();
    return [{ ...place, aboveM }, { ...place, aboveM: aboveM + kStreakRadii * radiusM }];
  });
}
