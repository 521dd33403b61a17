// Draws the pad's map on a canvas: water, land, course, objects, boats and fingers, from above.
import type { GameInfo } from "../../client/codec/game";
import type { BoatDetail, GreetingInfo } from "../../client/codec/greeting";
import type { PersonInfo } from "../../client/codec/people";
import type { FingerInfo } from "../../client/codec/strokes";
import type { BodyPose } from "../../client/codec/bodies";
import type { FloaterKindName, FloaterPose } from "../../client/codec/floaters";
import { clearanceM } from "../scene/landscape/clearance";
import { bedOf, groundHeightM } from "../scene/landscape/terrain";
import { kTeamColors } from "../ui/game_texts";
import type { WaterPlace } from "../ui/tools";
import { edgeOf, toPx, type MapView } from "./map_view";
import type { Preview } from "./pad_hands";
import { WaterShade, type MixedSurface } from "./water_shade";
import { kTexts } from "../ui/texts";

const kBackground = "#06202f";
const kFlatWater = "#166c92";
const kRockColor = "#9c9384";
const kRockEdge = "#5d564b";
/** What one has to reach next: a mark, or the ball. */
export const kNextColor = "#ffe14d";
const kMarkColor = "#ff8a2a";
/** Room of a name. */
const kNamePx = { width: 60, height: 14 };
/** Half the length of an arrow at the edge. */
const kArrowPx = 17;
/** Things are drawn at least so large. */
const kLeastPx = { boat: 16, floater: 9, mark: 9 };
const kKindColors: Record<FloaterKindName, string> = { crate: "#b3834a", ball: "#f4f4f0", barrel: "#8a4b2f", plank: "#c9a066", duck: "#ffd23f", buoy: "#ff5d3a", raft: "#d8b878", stone: "#8d9499" };
/** Corners of a boat seen from above, bow at x = 0.5: along and across, in lengths and beams. */
const kHull: readonly (readonly [number, number])[] = [[0.5, 0], [0.24, 0.42], [-0.1, 0.5], [-0.5, 0.4], [-0.5, -0.4], [-0.1, -0.5], [0.24, -0.42]];

export interface MapTarget extends WaterPlace {
  color: string;
}

interface MapThings {
  surface: MixedSurface | undefined;
  boats: readonly BodyPose[];
  details: readonly BoatDetail[];
  people: readonly PersonInfo[];
  floaters: readonly FloaterPose[];
  fingers: readonly FingerInfo[];
  ownFingers: readonly WaterPlace[];
  previews: readonly Preview[];
  ownId: number;
  ownBoatId: number;
  game: GameInfo | undefined;
  /** Index of the mark that the own boat has to round. */
  nextMark: number | undefined;
  /** What arrows at the edge of the map point to where the map does not show it. */
  targets: readonly MapTarget[];
  isNamed: boolean;
}

export class MapDrawing {
  private readonly context: CanvasRenderingContext2D;
  /** The water, a pixel per sample. */
  private readonly water = document.createElement("canvas");
  private readonly shade = new WaterShade();
  private image: ImageData | undefined;
  private isLand = new Uint8Array(0);
  private greeting: GreetingInfo | undefined;
  /** Where names are in this picture. */
  private readonly named: [x: number, y: number][] = [];

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.context = canvas.getContext("2d", { alpha: false })!;
  }

  enter(greeting: GreetingInfo): void {
    this.greeting = greeting;
    this.image = undefined;
  }

  /** Draws one picture. `pixelRatio`: pixels of the canvas per pixel of the view. */
  draw(view: MapView, things: MapThings, pixelRatio: number): void {
    const { context, canvas, greeting } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = kBackground;
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (!greeting) return;
    context.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
    this.drawWater(view, greeting, things.surface);
    this.drawObstacles(view, greeting);
    this.drawCourse(view, greeting, things);
    for (const floater of things.floaters) this.drawFloater(view, floater, floater.floaterId === things.game?.ballFloaterId);
    this.named.length = 0;
    for (const boat of things.boats) this.drawBoat(view, boat, things);
    this.drawHands(view, things);
    for (const target of things.targets) this.drawTarget(view, target);
  }

  private drawWater(view: MapView, greeting: GreetingInfo, surface: MixedSurface | undefined): void {
    const { context } = this;
    const { sideM, widthM } = greeting;
    const [x, y] = toPx(view, { xM: 0, zM: 0 });
    context.save();
    context.translate(x, y);
    context.rotate(view.turnRad);
    const [width, height] = [sideM * view.pxPerM, widthM * view.pxPerM];
    context.fillStyle = kFlatWater;
    context.fillRect(-width / 2, -height / 2, width, height);
    if (surface && this.fill(greeting, surface)) {
      context.imageSmoothingQuality = "high";
      context.drawImage(this.water, -width / 2, -height / 2, width, height);
    }
    context.strokeStyle = "rgb(255 255 255 / 0.35)";
    context.lineWidth = 2;
    context.strokeRect(-width / 2, -height / 2, width, height);
    context.restore();
  }

  /** Shades the water; false where the canvas gives no memory for it. */
  private fill(greeting: GreetingInfo, surface: MixedSurface): boolean {
    const { resolutionCount, countZ } = surface;
    const context = this.water.getContext("2d");
    if (!context) return false;
    if (this.image?.width !== resolutionCount || this.image.height !== countZ) {
      this.water.width = resolutionCount;
      this.water.height = countZ;
      this.image = new ImageData(resolutionCount, countZ);
      this.isLand = landOf(greeting, resolutionCount, countZ);
    }
    this.shade.shade(surface, this.isLand, this.image.data);
    context.putImageData(this.image, 0, 0);
    return true;
  }

  /** Sharper than the water's samples. */
  private drawObstacles(view: MapView, { obstacles }: GreetingInfo): void {
    const { context } = this;
    for (const obstacle of obstacles) {
      const [x, y] = toPx(view, obstacle);
      if (obstacle.shape === "rock") {
        this.disc(x, y, obstacle.radiusM * view.pxPerM, kRockColor, kRockEdge);
        continue;
      }
      const [length, width] = [obstacle.lengthM * view.pxPerM, obstacle.widthM * view.pxPerM];
      context.save();
      context.translate(x, y);
      context.rotate(view.turnRad + obstacle.headingRad);
      context.fillStyle = kRockColor;
      context.strokeStyle = kRockEdge;
      context.lineWidth = 2;
      context.fillRect(-length / 2, -width / 2, length, width);
      context.strokeRect(-length / 2, -width / 2, length, width);
      context.restore();
    }
  }

  /** Marks and goals; of a game only those that it needs. */
  private drawCourse(view: MapView, { course }: GreetingInfo, { game, nextMark }: MapThings): void {
    const { context } = this;
    if (!course) return;
    for (const team of ["red", "blue"] as const) {
      const goal = course.goals?.[team];
      if (!goal || game?.kind === "race") continue;
      const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, z]) => toPx(view, { xM: goal.xM + (x! * goal.lengthM) / 2, zM: goal.zM + (z! * goal.widthM) / 2 }));
      this.shape(corners);
      context.fillStyle = `${kTeamColors[team]}55`;
      context.strokeStyle = kTeamColors[team];
      context.lineWidth = 3;
      context.fill();
      context.stroke();
      this.text(kTexts.goalOf(team), ...toPx(view, goal), "#ffffff", "700 12px system-ui, sans-serif", true);
    }
    if (game?.kind === "ball") return;
    course.marks.forEach((mark, n) => {
      const [x, y] = toPx(view, mark);
      const isNext = n === nextMark;
      if (isNext) {
        context.setLineDash([7, 5]);
        this.ring(x, y, mark.radiusM * view.pxPerM, kNextColor, 2.5);
        context.setLineDash([]);
      }
      this.disc(x, y, isNext ? kLeastPx.mark + 3 : kLeastPx.mark, isNext ? kNextColor : kMarkColor, "#20130a");
      this.text(String(n + 1), x, y, "#20130a", "700 12px system-ui, sans-serif");
    });
  }

  /** An arrow from the middle of the view to the edge, if the target is beyond it. */
  private drawTarget(view: MapView, target: MapTarget): void {
    const { context, canvas } = this;
    const edge = edgeOf(view, toPx(view, target), { widthPx: canvas.clientWidth, heightPx: canvas.clientHeight });
    if (!edge) return;
    context.save();
    context.translate(edge.xPx, edge.yPx);
    context.rotate(edge.angleRad);
    this.shape([[kArrowPx, 0], [-0.7 * kArrowPx, 0.8 * kArrowPx], [-0.3 * kArrowPx, 0], [-0.7 * kArrowPx, -0.8 * kArrowPx]]);
    context.fillStyle = target.color;
    context.strokeStyle = "#04202f";
    context.lineWidth = 3;
    context.stroke();
    context.fill();
    context.restore();
  }

  private drawFloater(view: MapView, { kind, xM, zM, sizeM, isHeld }: FloaterPose, isBall: boolean): void {
    const [x, y] = toPx(view, { xM, zM });
    const radiusPx = Math.max(kLeastPx.floater, sizeM * view.pxPerM) / 2;
    if (kind === "crate" || kind === "plank" || kind === "raft") {
      const halfPx = kind === "plank" ? radiusPx * 0.4 : radiusPx;
      this.context.fillStyle = kKindColors[kind];
      this.context.fillRect(x - radiusPx, y - halfPx, 2 * radiusPx, 2 * halfPx);
    } else {
      this.disc(x, y, radiusPx, kKindColors[kind], "rgb(0 20 30 / 0.6)");
    }
    if (isBall) this.ring(x, y, radiusPx + 5, kNextColor, 2.5);
    else if (isHeld) this.ring(x, y, radiusPx + 3, "#5fd4e6", 2);
  }

  private drawBoat(view: MapView, pose: BodyPose, { details, people, ownBoatId, isNamed }: MapThings): void {
    const { context } = this;
    const detail = details.find(({ boatId }) => boatId === pose.boatId);
    const owner = people.find(({ boatIds }) => boatIds.includes(pose.boatId));
    const isOwn = pose.boatId === ownBoatId;
    const lengthM = detail?.lengthM ?? 2;
    const scale = Math.max(view.pxPerM, kLeastPx.boat / lengthM);
    const [x, y] = toPx(view, pose);
    context.save();
    context.translate(x, y);
    context.rotate(view.turnRad + pose.headingRad);
    this.shape(kHull.map(([along, across]) => [along * lengthM * scale, across * Math.max(detail?.beamM ?? 1, 0.38 * lengthM) * scale]));
    context.fillStyle = owner?.color ?? "#c9d3d8";
    context.strokeStyle = isOwn ? "#ffffff" : owner?.team ? kTeamColors[owner.team] : "rgb(0 20 30 / 0.7)";
    context.lineWidth = isOwn ? 3 : 2;
    context.fill();
    context.stroke();
    context.restore();
    if (isOwn && owner?.team) this.ring(x, y, 0.75 * lengthM * scale, kTeamColors[owner.team], 2);
    if (isNamed && owner && !isOwn) this.name(owner.name, x, y - 0.6 * lengthM * scale - 8);
  }

  /** Leaves a name out that would lie over another. */
  private name(name: string, x: number, y: number): void {
    if (this.named.some(([otherX, otherY]) => Math.abs(x - otherX) < kNamePx.width && Math.abs(y - otherY) < kNamePx.height)) return;
    this.named.push([x, y]);
    this.text(name, x, y, "#ffffff", "600 12px system-ui, sans-serif", true);
  }

  private drawHands(view: MapView, { fingers, people, ownId, ownFingers, previews }: MapThings): void {
    const { context } = this;
    const ownColor = people.find(({ personId }) => personId === ownId)?.color ?? "#ffffff";
    for (const { personId, xM, zM, radiusM } of fingers) {
      if (personId === ownId) continue;
      const [x, y] = toPx(view, { xM, zM });
      this.ring(x, y, Math.max(radiusM * view.pxPerM, 7), people.find((person) => person.personId === personId)?.color ?? "#ffffff", 2.5);
    }
    for (const place of ownFingers) {
      const [x, y] = toPx(view, place);
      this.disc(x, y, 7, ownColor, "#ffffff");
    }
    for (const preview of previews) {
      if (preview.kind === "ring") {
        const [x, y] = toPx(view, preview.at);
        this.ring(x, y, Math.max(preview.radiusM * view.pxPerM, 18), "#ffffff", 2);
        continue;
      }
      const [from, to] = [toPx(view, preview.from), toPx(view, preview.to)];
      const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
      context.beginPath();
      context.moveTo(...from);
      context.lineTo(...to);
      for (const side of [-1, 1]) {
        context.moveTo(...to);
        context.lineTo(to[0] - 18 * Math.cos(angle + 0.5 * side), to[1] - 18 * Math.sin(angle + 0.5 * side));
      }
      context.strokeStyle = "#ffffff";
      context.lineWidth = 4;
      context.lineCap = "round";
      context.stroke();
    }
  }

  private shape(corners: readonly (readonly number[])[]): void {
    const { context } = this;
    context.beginPath();
    corners.forEach(([x, y], n) => (n === 0 ? context.moveTo(x!, y!) : context.lineTo(x!, y!)));
    context.closePath();
  }

  private ring(x: number, y: number, radiusPx: number, color: string, widthPx: number): void {
    const { context } = this;
    context.beginPath();
    context.arc(x, y, radiusPx, 0, 2 * Math.PI);
    context.strokeStyle = color;
    context.lineWidth = widthPx;
    context.stroke();
  }

  private disc(x: number, y: number, radiusPx: number, color: string, edge: string): void {
    this.ring(x, y, radiusPx, edge, 2);
    this.context.fillStyle = color;
    this.context.fill();
  }

  private text(text: string, x: number, y: number, color: string, font: string, isOutlined = false): void {
    const { context } = this;
    context.font = font;
    context.textAlign = "center";
    context.textBaseline = "middle";
    if (isOutlined) {
      context.strokeStyle = "rgb(0 24 36 / 0.85)";
      context.lineWidth = 3;
      context.strokeText(text, x, y);
    }
    context.fillStyle = color;
    context.fillText(text, x, y + 0.5);
  }
}

/** 1 for samples on land and obstacles. */
function landOf(greeting: GreetingInfo, countX: number, countZ: number): Uint8Array<ArrayBuffer> {
  const bed = bedOf(greeting);
  const isLand = new Uint8Array(countX * countZ);
  for (let k = 0; k < countZ; ++k)
    for (let i = 0; i < countX; ++i) {
      const xM = ((i + 0.5) / countX - 0.5) * greeting.sideM;
      const zM = ((k + 0.5) / countZ - 0.5) * greeting.widthM;
      if (groundHeightM(bed, xM, zM) > 0 || greeting.obstacles.some((obstacle) => clearanceM(obstacle, xM, zM) < 0)) isLand[countX * k + i] = 1;
    }
  return isLand;
}
