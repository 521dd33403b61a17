// The pad's map over time: frames of the server, the view of the moment, and one picture of both.
import type { Haptics } from "../app/haptics";
import type { GreetingInfo } from "../../client/codec/greeting";
import type { GroundGrid } from "../../client/codec/ground";
import type { FingerInfo } from "../../client/codec/strokes";
import type { Frame } from "../net/messages";
import type { BodyPose } from "../../client/codec/bodies";
import { mixBodies } from "../scene/frames/bodies";
import type { FloaterPose } from "../../client/codec/floaters";
import { mixFloaters } from "../scene/frames/floaters";
import { elevationAtM } from "../scene/frames/height_field";
import { StreamedFrames } from "../scene/frames/streamed_frames";
import { mixAngle } from "../scene/maths/interpolate";
import { goalTeamOf, kTeamColors, nextMarkOf } from "../ui/game_texts";
import type { LessonState } from "../ui/lesson_state";
import type { WaterPlace } from "../ui/tools";
import { kNextColor, MapDrawing, type MapTarget } from "./map_drawing";
import { boatView, ontoWater, toPlace, turnFor, wholeView, type MapView } from "./map_view";
import type { PadWater, Preview } from "./pad_hands";
import type { MixedSurface } from "./water_shade";

/** Canvases with more pixels cost battery, and the water has no more detail. */
const kPixelRatioMax = 2;
/** The boat's map follows the heading by this share per second of what is left. */
const kTurnPerS = 3;
const kUnknownLengthM = 2;

interface MapMoment {
  /** The boat that the map follows; 0: the whole water. */
  followedId: number;
  ownBoatId: number;
  fingers: readonly FingerInfo[];
  ownFingers: readonly WaterPlace[];
  previews: readonly Preview[];
}

/** One's boat as it is shown. */
export interface OwnPose {
  timeS: number;
  speedMps: number;
  headingRad: number;
}

export class PadMap {
  /** Newest time of the simulation. */
  simTimeS = 0;
  private readonly drawing: MapDrawing;
  private frames: StreamedFrames | undefined;
  private greeting: GreetingInfo | undefined;
  private view: MapView | undefined;
  private turnRad = 0;
  private drawnS = 0;
  private readonly boatPoses: BodyPose[] = [];
  private readonly floaterPoses: FloaterPose[] = [];
  private boatsCount = 0;
  private floatersCount = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.drawing = new MapDrawing(canvas);
  }

  /** Lets the hand feel what happens to a boat. Call it after each picture. */
  feel(haptics: Haptics, boatId: number): void {
    if (this.frames) haptics.follow({ frames: this.frames, heightAtM: this.heightAtM }, this.greeting, boatId);
  }

  /** `release` takes back the frames that are not needed any more. */
  enter(greeting: GreetingInfo, release: (frame: Frame) => void): void {
    const isSame = this.greeting?.sideM === greeting.sideM && this.greeting.widthM === greeting.widthM && this.greeting.room === greeting.room;
    this.greeting = greeting;
    this.frames ??= new StreamedFrames(release);
    this.frames.enter(greeting.wave !== undefined, isSame);
    this.drawing.enter(greeting);
  }

  setGround(ground: GroundGrid): void {
    if (!this.greeting) return;
    this.greeting.ground = ground;
    this.drawing.enter(this.greeting);
  }

  /** Takes ownership of a frame; false if it does not need it. */
  take(frame: Frame): boolean {
    this.simTimeS = frame.timeS;
    this.frames?.take(frame, performance.now() / 1000);
    return this.frames !== undefined;
  }

  /** The server's clock minus the page's. */
  sync(leadS: number): void {
    this.frames?.clock.sync(leadS);
  }

  boats(): WaterPlace[] {
    return this.boatPoses.slice(0, this.boatsCount).map(({ xM, zM }) => ({ xM, zM }));
  }

  counts(): { surfaceCells: number; boats: number; floaters: number } {
    const frame = this.frames?.surfaces.newest();
    return { surfaceCells: frame ? frame.resolutionCount * frame.countZ : 0, boats: this.boatsCount, floaters: this.floatersCount };
  }

  private readonly heightAtM = (xM: number, zM: number): number => {
    const frame = this.frames?.surfaces.newest();
    return frame ? elevationAtM(frame, xM, zM) : 0;
  };

  /** What fingers on the map need to know; undefined before the first picture. */
  water(): PadWater | undefined {
    const { greeting, view } = this;
    if (!greeting || !view) return undefined;
    return {
      greeting,
      pxPerM: view.pxPerM,
      placeOf: (xPx, yPx) => ontoWater(toPlace(view, xPx, yPx), greeting),
      floaters: this.floaterPoses.slice(0, this.floatersCount),
      heightAtM: ({ xM, zM }) => this.heightAtM(xM, zM),
    };
  }

  /** Draws one picture, and returns one's boat in it. */
  draw(nowS: number, lessons: LessonState, moment: MapMoment): OwnPose | undefined {
    const { canvas, greeting, frames } = this;
    const size = { widthPx: canvas.clientWidth, heightPx: canvas.clientHeight };
    const pixelRatio = Math.min(window.devicePixelRatio || 1, kPixelRatioMax);
    const [width, height] = [Math.round(size.widthPx * pixelRatio), Math.round(size.heightPx * pixelRatio)];
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    if (!greeting || !frames || width === 0 || height === 0) return undefined;
    const shownS = frames.clock.displayTimeS(nowS);
    this.place(shownS, greeting);
    const boats = this.boatPoses.slice(0, this.boatsCount);
    const followed = boats.find(({ boatId }) => boatId === moment.followedId);
    this.view = this.viewOf(nowS, greeting, followed, size);
    this.drawing.draw(this.view, {
      ...moment,
      surface: shownS === undefined ? undefined : this.surfaceAt(shownS),
      boats,
      details: greeting.boats,
      people: lessons.people,
      floaters: this.floaterPoses.slice(0, this.floatersCount),
      ownId: lessons.ownId,
      game: lessons.game,
      nextMark: nextMarkOf(lessons.game, lessons.ownId),
      targets: followed ? this.targets(greeting, lessons) : [],
      isNamed: followed !== undefined,
    }, pixelRatio);
    const own = boats.find(({ boatId }) => boatId === moment.ownBoatId);
    return own && { timeS: shownS ?? 0, speedMps: own.speedMps, headingRad: own.headingRad };
  }

  /** The next mark, or the ball and the goal that it has to go into. */
  private targets({ course }: GreetingInfo, { game, ownId, me }: LessonState): MapTarget[] {
    const mark = course?.marks[nextMarkOf(game, ownId) ?? -1];
    const ball = game?.kind === "ball" && game.phase !== "over" ? this.floaterPoses.slice(0, this.floatersCount).find(({ floaterId }) => floaterId === game.ballFloaterId) : undefined;
    const team = goalTeamOf(game, me?.team);
    const goal = team && course?.goals?.[team];
    return [...(goal ? [{ ...goal, color: kTeamColors[team] }] : []), ...[mark, ball].flatMap((at) => (at ? [{ xM: at.xM, zM: at.zM, color: kNextColor }] : []))];
  }

  private place(shownS: number | undefined, greeting: GreetingInfo): void {
    const bodies = shownS === undefined ? undefined : this.frames!.bodies.around(shownS);
    this.boatsCount = bodies ? mixBodies(bodies.from, bodies.to, bodies.mix, this.boatPoses) : 0;
    const floaters = shownS === undefined ? undefined : this.frames!.floaters.around(shownS);
    this.floatersCount = floaters ? mixFloaters(floaters.from, floaters.to, floaters.mix, greeting, this.floaterPoses) : 0;
  }

  private viewOf(nowS: number, greeting: GreetingInfo, followed: BodyPose | undefined, size: { widthPx: number; heightPx: number }): MapView {
    const elapsedS = Math.min(nowS - this.drawnS, 0.5);
    this.drawnS = nowS;
    if (!followed) {
      this.turnRad = Number.NaN;
      return wholeView(greeting, size);
    }
    const wanted = turnFor(followed.headingRad);
    this.turnRad = Number.isNaN(this.turnRad) ? wanted : mixAngle(this.turnRad, wanted, 1 - Math.exp(-kTurnPerS * elapsedS));
    const lengthM = greeting.boats.find(({ boatId }) => boatId === followed.boatId)?.lengthM ?? kUnknownLengthM;
    return boatView({ xM: followed.xM, zM: followed.zM, lengthM }, this.turnRad, greeting.waterExtents.sideM, size);
  }

  private surfaceAt(shownS: number): MixedSurface | undefined {
    const between = this.frames!.surfaces.around(shownS);
    if (!between) return undefined;
    const { from, mix } = between;
    // After a change of the fidelity the next frame has another grid.
    const to = between.to.resolutionCount === from.resolutionCount && between.to.countZ === from.countZ ? between.to : from;
    const { resolutionCount, countZ, sideM, widthM } = from;
    return { resolutionCount, countZ, sideM, widthM, from: new Int16Array(from.buffer), to: new Int16Array(to.buffer), mix, fromQuantumM: from.quantumM, toQuantumM: to.quantumM };
  }
}
