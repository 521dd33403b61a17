// The tools: what a tap, a drag or a long press on the water does with each, and the commands that it sends. Sizes follow from the water.
import type { GreetingInfo } from "../../client/codec/greeting";
import { kBreakingWaveRanges, kStrokeRanges } from "../../client/gen/ranges";
import { Side, WaveShape } from "../../client/gen/spindrift/v1/scene_pb";
import { StrokeTool } from "../../client/gen/spindrift/v1/wire_pb";
import type { CommandAction } from "../../client/session/events";
import { clampTo, type EffectLimits } from "./effect_limits";

export type ToolName = "finger" | "splash" | "paddle" | "rain" | "calm" | "float" | "throw";

export interface Tool {
  name: ToolName;
  /** For tools that are drawn as strokes. */
  stroke?: StrokeTool;
  /** Only operators may use it. */
  isOperators?: true;
  /** Only in scenes with objects in the water. */
  needsFloaters?: true;
}

export const kTools: readonly Tool[] = [
  { name: "finger", stroke: StrokeTool.FINGER },
  { name: "splash" },
  { name: "paddle" },
  { name: "rain", stroke: StrokeTool.RAIN },
  { name: "calm", stroke: StrokeTool.CALM, isOperators: true },
  { name: "float", needsFloaters: true },
  { name: "throw", needsFloaters: true },
];

/** What the user chose for a tool, over what suits the water. */
export interface ToolScale {
  sizeRatio: number;
  /** At most 1. */
  strengthRatio: number;
}

/** How long a tap's stroke lasts that is not a splash. */
export const kTapStrokeS: Partial<Record<ToolName, number>> = { rain: 8, calm: 4 };

/** A splash that is held grows to this many times its size, in this time after the tap. */
const kHeldLargest = 2.5;
const kHeldS = 1.5;
/** Shares of the shorter side: radius of a finger, of a cloud or a calmed disc; a paddle's width, the length of its wave (no
    longer than the slowest ripples where there are any), and the drag that makes it highest. */
const kSides = { finger: 0.025, disc: 0.1, paddleWidth: 0.3, paddleLength: 0.1, paddleDrag: 0.35 };
/** Depth of a finger in radii, height of a paddle's wave over its length; both at most a share of the water's depth. */
const kFingerDepth = { radii: 0.45, depths: 0.2 };
const kPaddleHeight = { lengths: 0.25, depths: 0.3 };
/** Shortest drag of a paddle, as a share of the shorter side. */
const kShortestDrag = 0.02;

export interface WaterPlace {
  xM: number;
  zM: number;
}

export interface StrokeSize {
  tool: StrokeTool;
  radiusM: number;
  depthM: number;
}

type Water = Pick<GreetingInfo, "waterExtents">;

/** Size of a tool's stroke; undefined for a tool without strokes. */
export function strokeSize(tool: Tool, { waterExtents: { sideM, depthM } }: Water, { sizeRatio }: ToolScale): StrokeSize | undefined {
  if (tool.stroke === undefined) return undefined;
  const isFinger = tool.stroke === StrokeTool.FINGER;
  const radiusM = clampTo(sizeRatio * (isFinger ? kSides.finger : kSides.disc) * sideM, kStrokeRanges.radiusM);
  return { tool: tool.stroke, radiusM, depthM: clampTo(Math.min(kFingerDepth.radii * radiusM, kFingerDepth.depths * depthM), kStrokeRanges.depthM) };
}

/** Factor of a splash's size that was held this long. */
export function heldRatio(heldS: number): number {
  return 1 + (kHeldLargest - 1) * Math.min(Math.max(heldS, 0) / kHeldS, 1);
}

/** A splash of `radiusM` and `depthM`, as the sliders say, scaled; within the limits of the water. */
export function splashOf(place: WaterPlace, size: { splashRadiusM: number; splashDepthM: number }, limits: EffectLimits, { sizeRatio, strengthRatio }: ToolScale): CommandAction {
  const radiusM = clampTo(sizeRatio * size.splashRadiusM, limits.splashRadiusM);
  const depthM = clampTo(strengthRatio * sizeRatio * size.splashDepthM, limits.splashDepthM);
  return { case: "splash", value: { ...place, radiusM, depthM } };
}

/** The wave of a paddle that was dragged from one place to another; undefined for a drag that is too short. */
export function paddleWave(from: WaterPlace, to: WaterPlace, { waterExtents: { sideM, depthM, rippleM = Infinity } }: Water, { sizeRatio, strengthRatio }: ToolScale): CommandAction | undefined {
  const dragM = Math.hypot(to.xM - from.xM, to.zM - from.zM);
  if (dragM < kShortestDrag * sideM) return undefined;
  const lengthM = clampTo(Math.min(kSides.paddleLength * sideM, rippleM), kBreakingWaveRanges.lengthM);
  const highestM = Math.min(kPaddleHeight.lengths * lengthM, kPaddleHeight.depths * depthM);
  return {
    case: "breakingWave",
    value: {
      side: Side.DIRECTION,
      shape: WaveShape.SWELL,
      directionDeg: (Math.atan2(to.zM - from.zM, to.xM - from.xM) * 180) / Math.PI,
      lengthM,
      amplitudeM: clampTo(highestM * strengthRatio * Math.min(dragM / (kSides.paddleDrag * sideM), 1), kBreakingWaveRanges.amplitudeM),
      widthM: clampTo(paddleWidthM(sideM, sizeRatio), kBreakingWaveRanges.widthM),
      ...to,
    },
  };
}

export function paddleWidthM(sideM: number, sizeRatio: number): number {
  return kSides.paddleWidth * sizeRatio * sideM;
}
