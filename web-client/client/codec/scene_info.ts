// What a scene has besides its water: setting, sides, wind sea, rocks, breakwaters and beaches, as plain, finite numbers.
import { Bulk, Dispersion, Setting, Side, WaterType, WaveBoundary, type Scene, type WaveScene } from "../gen/spindrift/v1/scene_pb";

/** As many as the server allows, or more; the rest is ignored. */
const kMaxObstacleCount = 256;
export const kMaxGaugeCount = 64;

export type WaterTypeName = "pool" | "ocean" | "coast" | "harbor" | "lagoon";
export type SettingName = "openSea" | "pool" | "glassTank" | "flume";
/** In the order of shader uniforms. */
export const kSideNames = ["+x", "-x", "+z", "-z"] as const;
export type SideName = (typeof kSideNames)[number];
/** What waves do at a side: come in again opposite, stay inside, or leave. */
export type SideKind = "periodic" | "closed" | "open";

export interface WaveInfo {
  /** Cells along x and along z. */
  resolutionCount: number;
  countZ: number;
  /** Length along x. */
  sideM: number;
  /** Width along z. */
  widthM: number;
  depthM: number;
  periodicX: boolean;
  periodicZ: boolean;
  sides: Record<SideName, SideKind>;
  /** Width of the layer along open sides in which waves are absorbed. */
  spongeWidthM: number;
  dampingPerS: number;
  /** Water moves over its shore: elevations of dry cells are those of the ground. */
  isNonlinear: boolean;
  /** Waves steepen in linear water, straight as the sides they came from; left out: no. */
  isSteepening?: boolean;
}

/** What the sea that wind raises follows from, as in the server (docs/wind_sea.md). */
export interface WindInfo {
  seed: bigint;
  gravityMps2: number;
  /** The water has dispersion and an open side, so that the wind's waves come in through the open sides; elsewhere gusts raise single crests. */
  comesIn: boolean;
  levelRatio: number;
  /** Drops at full storm. */
  dropsPerM2S: number;
  waveHeightM: number;
  directionDeg: number;
  speedMps: number;
  fetchM: number;
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

export interface BeachInfo {
  side: SideName;
  widthM: number;
  shoreDepthM: number;
}

function sideKind(boundary: WaveBoundary): SideKind {
  return boundary === WaveBoundary.ABSORB ? "open" : boundary === WaveBoundary.REFLECT ? "closed" : "periodic";
}

/** As in the server: cells are square, and there are as many along z as make up the width. */
function cellsOf({ resolutionCount = 0, sideM = 0, widthM = 0 }: WaveScene): Pick<WaveInfo, "resolutionCount" | "countZ" | "sideM" | "widthM"> {
  if (!(widthM > 0 && widthM <= 1e6) || !(resolutionCount > 0 && sideM > 0)) return { resolutionCount, countZ: resolutionCount, sideM, widthM: sideM };
  return { resolutionCount, countZ: Math.max(Math.round((widthM * resolutionCount) / sideM), 1), sideM, widthM };
}

export function readWave(wave: WaveScene): WaveInfo {
  const sides = {
    "+x": sideKind(wave.boundaryPlusX),
    "-x": sideKind(wave.boundaryMinusX),
    "+z": sideKind(wave.boundaryPlusZ),
    "-z": sideKind(wave.boundaryMinusZ),
  };
  const spongeWidthM = wave.spongeWidthM ?? 0;
  const dampingPerS = wave.dampingPerS ?? 0;
  return {
    ...cellsOf(wave),
    depthM: wave.depthM ?? 0,
    periodicX: sides["+x"] === "periodic" && sides["-x"] === "periodic",
    periodicZ: sides["+z"] === "periodic" && sides["-z"] === "periodic",
    sides,
    spongeWidthM: isSize(spongeWidthM) ? spongeWidthM : 0,
    dampingPerS: Number.isFinite(dampingPerS) ? Math.max(dampingPerS, 0) : 0,
    isNonlinear: wave.bulk === Bulk.NONLINEAR,
    isSteepening: wave.bulk !== Bulk.NONLINEAR && (wave.steepeningRatio ?? 0) > 0,
  };
}

const kSettings: Partial<Record<Setting, SettingName>> = {
  [Setting.OPEN_SEA]: "openSea",
  [Setting.POOL]: "pool",
  [Setting.GLASS_TANK]: "glassTank",
  [Setting.FLUME]: "flume",
};

/** Returns the scene's setting. A server that names none, or one that this client does not know, gets a simple one for its parts. */
export function readSetting(scene: Scene): SettingName {
  const wave = scene.wave && readWave(scene.wave);
  const named = kSettings[scene.setting];
  if (named && (wave || named !== "openSea")) return named;
  if (!wave) return "glassTank";
  return Object.values(wave.sides).every((kind) => kind === "closed") ? "pool" : "openSea";
}

const kWaterTypes: Partial<Record<WaterType, WaterTypeName>> = {
  [WaterType.POOL]: "pool",
  [WaterType.OCEAN]: "ocean",
  [WaterType.COAST]: "coast",
  [WaterType.HARBOR]: "harbor",
  [WaterType.LAGOON]: "lagoon",
};

/** Returns the optical type of the water; a server that names none, or one that this client does not know, has a sea or a pool. */
export function readWaterType(scene: Scene): WaterTypeName {
  return kWaterTypes[scene.waterType] ?? (readSetting(scene) === "openSea" ? "coast" : "pool");
}

/** What a visitor sees first: a rectangle of the water. `acrossM` 0: as much as suits the setting; `awayM` 0: as long as across. */
export interface FirstViewInfo {
  xM: number;
  zM: number;
  /** Sides across the picture and away from the camera. */
  acrossM: number;
  awayM: number;
  /** Where the camera looks, from +x toward +z, and by how much down. */
  headingRad: number;
  pitchRad: number;
  /** Hour of the light. */
  hour: number;
  /** What the view is about, to the right of the rectangle's middle. */
  subjectRightM: number;
}

/** Returns the first view of a scene; undefined without one, or with numbers that cannot be drawn. */
export function readFirstView({ firstView }: Scene): FirstViewInfo | undefined {
  if (!firstView) return undefined;
  const { xM = 0, zM = 0, acrossM = 0, awayM = 0, headingDeg = -90, pitchDeg = 22, hour = 12, subjectRightM = 0 } = firstView;
  const isDrawable = [xM, zM, headingDeg, subjectRightM].every(Number.isFinite) && [acrossM, awayM].every((sizeM) => sizeM >= 0 && sizeM <= 1e6) && pitchDeg > 0 && pitchDeg < 90 && hour >= 0 && hour <= 24;
  return isDrawable ? { xM, zM, acrossM, awayM, headingRad: (headingDeg * Math.PI) / 180, pitchRad: (pitchDeg * Math.PI) / 180, hour, subjectRightM } : undefined;
}

/** Returns whether closed sides without a beach are rocky shores: beside a beach, quays look like those of a canal. */
export function hasRockyShores(beaches: readonly BeachInfo[]): boolean {
  return beaches.length > 0;
}

/** Returns the wind of a scene with a storm; undefined without one, or with numbers that cannot be drawn. */
export function readWind(scene: Scene): WindInfo | undefined {
  const { storm, wave } = scene;
  if (!storm || !wave) return undefined;
  const { levelRatio = 0, dropsPerM2S = 0, waveHeightM = 0, windDirectionDeg = 0, windSpeedMps = 0, fetchM = 0 } = storm;
  const read: WindInfo = {
    seed: scene.seed,
    gravityMps2: scene.gravityMps2 ?? 0,
    comesIn: wave.dispersion === Dispersion.AIRY && Object.values(readWave(wave).sides).includes("open"),
    levelRatio,
    dropsPerM2S,
    waveHeightM,
    directionDeg: windDirectionDeg,
    speedMps: windSpeedMps,
    fetchM,
  };
  const isDrawable = [read.gravityMps2, levelRatio, dropsPerM2S, waveHeightM, windSpeedMps, fetchM].every((value) => value >= 0 && value <= 1e7);
  return isDrawable && isPlace(windDirectionDeg) ? read : undefined;
}

const isSize = (value: number): boolean => value > 0 && value <= 1e6;
export const isPlace = (value: number): boolean => Math.abs(value) <= 1e6;

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
    if (!side || !isSize(widthM) || !(Math.abs(shoreDepthM) <= 1e6)) continue;
    if (!read.some((other) => other.side === side)) read.push({ side, widthM, shoreDepthM });
  }
  return read;
}

/** A position where the server measures the water. */
export interface GaugeInfo {
  name: string;
  xM: number;
  zM: number;
  /** Of one that a person has placed, and not the scene. */
  placed?: { gaugeId: number; personId: number };
}

export function readGauges(scene: Scene): GaugeInfo[] {
  return scene.gauges.slice(0, kMaxGaugeCount).map(({ name, xM = 0, zM = 0 }) => ({ name, xM, zM })).filter(({ xM, zM }) => isPlace(xM) && isPlace(zM));
}
