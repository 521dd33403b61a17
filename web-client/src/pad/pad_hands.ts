// Fingers on the pad's map: each uses the tool that is chosen, and what they do is shown until the water shows it.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { LessonTool } from "../../client/codec/lesson";
import type { CommandAction } from "../../client/session/events";
import type { FloaterKindName, FloaterPose } from "../../client/codec/floaters";
import { kRadiusSizes } from "../scene/frames/floaters";
import { effectLimits } from "../ui/effect_limits";
import { dropOf, flickOf, floaterSizeM, throwOf, tossTo } from "../ui/floater_tools";
import { HoldSender, kHoldLabel } from "../ui/hold_sender";
import type { SenderWorld } from "../ui/latest_sender";
import { kStrokeLabel, StrokeSender, type FingerPoint } from "../ui/stroke_sender";
import { heldRatio, kTapStrokeS, kTools, paddleWave, splashOf, strokeSize, type Tool, type WaterPlace } from "../ui/tools";
import { kTexts } from "../ui/texts";

/** A finger that has moved less is where it came down. */
const kStillPx = 10;
/** A press that is shorter is a tap. */
const kPadTapMs = 250;
/** An object is taken within this distance of it. */
const kTakePx = 26;
/** A pad's tool has this size and strength. */
const kScale = { sizeRatio: 1, strengthRatio: 1 };
const kDropped: readonly FloaterKindName[] = ["duck", "ball", "crate", "barrel", "buoy", "plank"];
/** The tool of the page that a tool of the lesson is; a boat has a helm. */
const kPageTools: Record<Exclude<LessonTool, "boat">, string> = { finger: "finger", splash: "splash", wave: "paddle", rain: "rain", float: "float", throw: "throw" };

/** What a finger is about to do, for the map. */
export type Preview = { kind: "ring"; at: WaterPlace; radiusM: number } | { kind: "arrow"; from: WaterPlace; to: WaterPlace };

interface Hand {
  tool: Tool;
  beganMs: number;
  downPx: readonly [number, number];
  from: WaterPlace;
  at: WaterPlace;
  isMoved: boolean;
}

export interface PadWater {
  greeting: GreetingInfo;
  /** Where a point of the map is; on the water. */
  placeOf(xPx: number, yPx: number): WaterPlace;
  pxPerM: number;
  floaters: readonly FloaterPose[];
  heightAtM(place: WaterPlace): number;
}

export class PadHands {
  private readonly hands = new Map<number, Hand>();
  private readonly strokes: StrokeSender;
  private readonly holds: HoldSender;

  /** `send` returns the command's id, 0 if nothing was sent; `world` has the time of pointer events. */
  constructor(
    private readonly send: (action: CommandAction, label: string) => number,
    private readonly world: SenderWorld,
    private readonly random: () => number,
  ) {
    this.strokes = new StrokeSender((value) => send({ case: "stroke", value }, kStrokeLabel), world);
    this.holds = new HoldSender((value) => send({ case: "holdFloater", value }, kHoldLabel), () => {}, world);
  }

  answered(commandId: number, isRejected: boolean): void {
    this.holds.answered(commandId, isRejected);
  }

  /** `mode`: what the finger does until it is lifted. */
  press(pointerId: number, xPx: number, yPx: number, mode: Exclude<LessonTool, "boat">, water: PadWater): void {
    const tool = kTools.find(({ name }) => name === kPageTools[mode])!;
    const at = water.placeOf(xPx, yPx);
    this.hands.set(pointerId, { tool, beganMs: this.world.nowMs(), downPx: [xPx, yPx], from: at, at, isMoved: false });
    const size = strokeSize(tool, water.greeting, kScale);
    if (size) this.strokes.begin(pointerId, [this.pointAt(at)], size);
    const taken = mode === "float" ? nearest(water, at) : undefined;
    if (taken) this.holds.begin(pointerId, taken.floaterId, () => this.hands.get(pointerId)?.at ?? at);
  }

  move(pointerId: number, xPx: number, yPx: number, water: PadWater): void {
    const hand = this.hands.get(pointerId);
    if (!hand) return;
    hand.at = water.placeOf(xPx, yPx);
    hand.isMoved ||= Math.hypot(xPx - hand.downPx[0], yPx - hand.downPx[1]) > kStillPx;
    this.strokes.move(pointerId, this.pointAt(hand.at));
  }

  release(pointerId: number, water: PadWater): void {
    const hand = this.hands.get(pointerId);
    if (!hand) return;
    const isHolding = this.holds.heldBy(pointerId) !== 0;
    this.lift(pointerId);
    if (!isHolding) this.use(hand, water);
  }

  /** Lets go without using the tool. */
  lift(pointerId: number): void {
    this.hands.delete(pointerId);
    this.strokes.end(pointerId);
    this.holds.end(pointerId);
  }

  liftAll(): void {
    for (const pointerId of [...this.hands.keys()]) this.lift(pointerId);
  }

  /** Where this visitor's fingers are. */
  places(): WaterPlace[] {
    return [...this.hands.values()].map(({ at }) => at);
  }

  previews(greeting: GreetingInfo): Preview[] {
    return [...this.hands.values()].flatMap(({ tool, from, at, beganMs, isMoved }): Preview[] => {
      if ((tool.name === "paddle" || tool.name === "throw") && isMoved) return [{ kind: "arrow", from, to: at }];
      if (tool.name === "splash") return [{ kind: "ring", at, radiusM: (effectLimits(greeting)?.splashRadiusM.default ?? 1) * heldRatio((this.world.nowMs() - beganMs - kPadTapMs) / 1000) }];
      const size = strokeSize(tool, greeting, kScale);
      return size ? [{ kind: "ring", at, radiusM: size.radiusM }] : [];
    });
  }

  private use({ tool, from, at, beganMs, isMoved }: Hand, { greeting, heightAtM }: PadWater): void {
    const heldMs = this.world.nowMs() - beganMs;
    const size = strokeSize(tool, greeting, kScale);
    const stayS = kTapStrokeS[tool.name];
    if (tool.name === "splash") {
      const limits = effectLimits(greeting);
      if (!limits) return;
      const usual = { splashRadiusM: limits.splashRadiusM.default, splashDepthM: limits.splashDepthM.default };
      this.send(splashOf(at, usual, limits, { ...kScale, sizeRatio: heldRatio((heldMs - kPadTapMs) / 1000) }), kTexts.commands.splash);
    } else if (tool.name === "paddle") {
      const wave = paddleWave(from, at, greeting, kScale);
      if (wave) this.send(wave, kTexts.commands.wave);
    } else if (tool.name === "throw") {
      const thrown = isMoved ? flickOf(from, at, heldMs / 1000, heightAtM(from), greeting, kScale) : tossTo(at, { xM: at.xM, zM: greeting.widthM }, heightAtM(at), greeting);
      if (thrown) this.send(throwOf(thrown, floaterSizeM("throw", greeting, kScale)!, greeting), kTexts.commands.stone);
    } else if (tool.name === "float" && !isMoved) {
      const kind = kDropped[Math.floor(this.random() * kDropped.length)]!;
      const headingDeg = Math.round(360 * this.random() - 180);
      this.send(dropOf(kind, at, heightAtM(at), floaterSizeM("float", greeting, kScale)!, 0, headingDeg, greeting), kTexts.commands.object);
    } else if (size && stayS !== undefined && heldMs < kPadTapMs) {
      this.strokes.stay(at, size, stayS, 1);
    }
  }

  private pointAt(at: WaterPlace): FingerPoint {
    return { timeMs: this.world.nowMs(), ...at, pressureRatio: 1 };
  }
}

/** Returns the object nearest to a position that a finger there takes. */
function nearest({ floaters, pxPerM }: PadWater, { xM, zM }: WaterPlace): FloaterPose | undefined {
  const awayM = (pose: FloaterPose): number => Math.hypot(pose.xM - xM, pose.zM - zM) - kRadiusSizes[pose.kind] * pose.sizeM;
  const found = [...floaters].sort((a, b) => awayM(a) - awayM(b))[0];
  return found && awayM(found) * pxPerM < kTakePx ? found : undefined;
}
