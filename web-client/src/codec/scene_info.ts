// The solid parts of a scene: rocks, breakwaters and beaches, as plain, finite numbers.
import { Side, WaveBoundary, type Scene, type WaveScene } from "../gen/spindrift/v1/scene_pb";

/** More than the server allows; the rest is not drawn. */
const kMaxObstacleCount = 256;

export interface WaveInfo {
  resolutionCount: number;
  sideM: number;
  depthM: number;
  periodicX: boolean;
  periodicZ: boolean;
}

/** `heightM` above the still water, `radiusM` at its level. */
export interface RockInfo {
  shape: "rock";
  xM: number;
  zM: number;
  radiusM: number;
  heightM: number;
}

export interface BreakwaterInfo {
  shape: "breakwater";
  xM: number;
  zM: number;
  lengthM: number;
  widthM: number;
  /** From +x toward +z. */
  headingRad: number;
  heightM: number;
}

export type ObstacleInfo = RockInfo | BreakwaterInfo;
export type SideName = "+x" | "-x" | "+z" | "-z";

export interface BeachInfo {
  side: SideName;
  widthM: number;
  shoreDepthM: number;
}

export function readWave(wave: WaveScene): WaveInfo {
  const open = [WaveBoundary.REFLECT, WaveBoundary.ABSORB];
  return {
    resolutionCount: wave.resolutionCount ?? 0,
    sideM: wave.sideM ?? 0,
    depthM: wave.depthM ?? 0,
    periodicX: !open.includes(wave.boundaryMinusX) && !open.includes(wave.boundaryPlusX),
    periodicZ: !open.includes(wave.boundaryMinusZ) && !open.includes(wave.boundaryPlusZ),
  };
}

const isSize = (value: number): boolean => value > 0 && value <= 1e6;
const isPlace = (value: number): boolean => Math.abs(value) <= 1e6;

export function readObstacles(scene: Scene): ObstacleInfo[] {
  const read: ObstacleInfo[] = [];
  for (const { shape } of scene.obstacles.slice(0, kMaxObstacleCount)) {
    if (shape.case === "rock") {
      const { xM = 0, zM = 0, radiusM = 1, heightM = 0.8 } = shape.value;
      if (isPlace(xM) && isPlace(zM) && isSize(radiusM) && isSize(heightM)) read.push({ shape: "rock", xM, zM, radiusM, heightM });
    } else if (shape.case === "breakwater") {
      const { xM = 0, zM = 0, lengthM = 8, widthM = 1, headingDeg = 0, heightM = 0.8 } = shape.value;
      if (isPlace(xM) && isPlace(zM) && isSize(lengthM) && isSize(widthM) && isPlace(headingDeg) && isSize(heightM))
        read.push({ shape: "breakwater", xM, zM, lengthM, widthM, headingRad: (headingDeg * Math.PI) / 180, heightM });
    }
  }
  return read;
}

const kSides: Partial<Record<Side, SideName>> = {
  [Side.UNSPECIFIED]: "+x",
  [Side.PLUS_X]: "+x",
  [Side.MINUS_X]: "-x",
  [Side.PLUS_Z]: "+z",
  [Side.MINUS_Z]: "-z",
};

/** One beach per side: the first. */
export function readBeaches(scene: Scene): BeachInfo[] {
  const read: BeachInfo[] = [];
  for (const beach of scene.beaches) {
    const side = kSides[beach.side];
    const widthM = beach.widthM ?? 6;
    const shoreDepthM = beach.shoreDepthM ?? 0;
    if (!side || !isSize(widthM) || !(shoreDepthM >= 0 && shoreDepthM <= 1e6)) continue;
    if (!read.some((other) => other.side === side)) read.push({ side, widthM, shoreDepthM });
  }
  return read;
}
