// The outline of the tool on the water, before and while it is used: the disc that it acts on, or a paddle with the way of its wave.
import { Matrix4, Vector4, type PerspectiveCamera } from "three";

import type { WaterPlace } from "./tools";

const kSvg = "http://www.w3.org/2000/svg";
const kCornersCount = 40;
/** Length of an arrow's head over the arrow. */
const kHeadShare = 0.25;

export type Outline = { kind: "disc"; at: WaterPlace; radiusM: number } | { kind: "paddle"; from: WaterPlace; to: WaterPlace; widthM: number };

export class ToolPreview {
  private readonly svg = document.createElementNS(kSvg, "svg");
  private readonly path = document.createElementNS(kSvg, "path");
  private readonly seen = new Matrix4();
  private readonly corner = new Vector4();

  /** `before`: the outline lies over this element and under everything after it. */
  constructor(before: Element) {
    this.svg.setAttribute("class", "tool-preview");
    this.svg.setAttribute("aria-hidden", "true");
    this.svg.setAttribute("data-testid", "tool-preview");
    this.svg.append(this.path);
    before.after(this.svg);
  }

  /** Called for each picture. `outline` undefined: nothing is drawn. */
  update(outline: Outline | undefined, camera: PerspectiveCamera, heightAtM: (xM: number, zM: number) => number): void {
    this.seen.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const d = outline ? linesOf(outline).map((line) => this.draw(line, heightAtM)).join("") : "";
    if (this.path.getAttribute("d") !== d) this.path.setAttribute("d", d);
  }

  /** A line through these places, left out where a part of it is behind the camera. */
  private draw(line: readonly WaterPlace[], heightAtM: (xM: number, zM: number) => number): string {
    const points: string[] = [];
    for (const { xM, zM } of line) {
      const { x, y, w } = this.corner.set(xM, heightAtM(xM, zM), zM, 1).applyMatrix4(this.seen);
      if (!(w > 1e-6)) return "";
      points.push(`${((0.5 + (0.5 * x) / w) * window.innerWidth).toFixed(1)} ${((0.5 - (0.5 * y) / w) * window.innerHeight).toFixed(1)}`);
    }
    return `M${points.join("L")}`;
  }
}

/** The lines of an outline, along the still water. */
export function linesOf(outline: Outline): WaterPlace[][] {
  if (outline.kind === "disc") {
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
