// The greeting as plain data that survives postMessage: what clients need of the scene, without Protobuf objects.
import { CouplingMode, type ParticleScene, type Scene } from "../gen/spindrift/v1/scene_pb";
import type { BoatList, Greeting } from "../gen/spindrift/v1/wire_pb";
import { readCourse, type CourseInfo } from "./course";
import { fidelityName, readFidelityLevels, type FidelityLevelInfo, type FidelityName } from "./fidelity";
import type { GroundGrid } from "./ground";
import { kLayerNames, kLayers, type LayerName } from "./layers";
import { malformed, type Malformed } from "./malformed";
import {
  readBeaches,
  readFirstView,
  readGauges,
  readObstacles,
  readSetting,
  readWaterType,
  readWave,
  readWind,
  type BeachInfo,
  type FirstViewInfo,
  type GaugeInfo,
  type ObstacleInfo,
  type SettingName,
  type WaterTypeName,
  type WaveInfo,
  type WindInfo,
} from "./scene_info";

/** Version of the wire that this client speaks. */
export const kWireMajor = 1;
export const kWireMinor = 11;

export interface ParameterInfo {
  path: string;
  label: string;
  unit: string;
  min: number;
  max: number;
  step: number;
  default: number;
  value: number;
  help: string;
}

/** A boat's hull, metres. */
export interface BoatDetail {
  boatId: number;
  lengthM: number;
  beamM: number;
  heightM: number;
  draughtM: number;
}

/** Shorter and longer side and depth of the resting water, as in the server's rules. */
interface WaterExtents {
  sideM: number;
  longM: number;
  depthM: number;
  /** Length of the slowest ripples; only in water with surface tension. */
  rippleM?: number;
}

export interface GreetingInfo {
  versionMajor: number;
  versionMinor: number;
  server: string;
  device: string;
  room: string;
  sessionId: string;
  layers: LayerName[];
  frameRateMaxHz: number;
  /** On the server's monotonic clock. */
  serverTimeS: number;
  /** The scene's name in ChangeScene. */
  sceneName: string;
  title: string;
  description: string;
  /** Level at which the server simulates the scene. */
  fidelity: FidelityName;
  /** Levels that the scene can take; empty where the server does not say. */
  fidelityLevels: FidelityLevelInfo[];
  /** Where the water is. */
  setting: SettingName;
  waterType: WaterTypeName;
  /** Undefined: the view that suits the setting. */
  firstView: FirstViewInfo | undefined;
  /** Undefined in a scene without a heightfield. */
  wave: WaveInfo | undefined;
  /** Undefined in a scene without a storm. */
  wind: WindInfo | undefined;
  /** Length of the water along x, metres. */
  sideM: number;
  /** Width of the water along z. */
  widthM: number;
  /** Limits of effects and boats follow from these: the wave, or the resting water of a box of particles. */
  waterExtents: WaterExtents;
  hasParticles: boolean;
  /** Thickness of a layer of particles that the wave carries at its surface; 0 without one. */
  bandM: number;
  /** The server decides where the wave breaks. */
  hasBreakers: boolean;
  gravityMps2: number;
  /** Breaking water turns into particles and back. */
  isTwoWay: boolean;
  /** The scene allows boats. */
  hasBoats: boolean;
  /** The scene allows objects in the water, and the server streams them. */
  hasFloaters: boolean;
  /** For games; undefined without one. */
  course: CourseInfo | undefined;
  obstacles: ObstacleInfo[];
  beaches: BeachInfo[];
  gauges: GaugeInfo[];
  /** The scene has a bed: the ground does not follow from depth and beaches alone. */
  hasBed: boolean;
  /** The scene starts again by itself. */
  repeats: boolean;
  /** The ground of such a scene, once it has been asked for. */
  ground?: GroundGrid;
  boats: BoatDetail[];
  /** Scenes that ChangeScene accepts. */
  scenes: string[];
  parameters: ParameterInfo[];
  paused: boolean;
  speed: number;
  /** Those who hold the room's clock. */
  clockPersonIds: number[];
}

/** Returns the boats, or why the list cannot be trusted. */
export function readBoatList(list: BoatList): BoatDetail[] | string {
  const boats = list.boats.map(({ boatId, lengthM, beamM, heightM, draughtM }) => ({ boatId, lengthM, beamM, heightM, draughtM }));
  for (const { boatId, lengthM, beamM, heightM, draughtM } of boats) {
    if (![lengthM, beamM, heightM].every((size) => size > 0 && size <= 1e4)) return `boat ${boatId}: hull of ${lengthM} m by ${beamM} m by ${heightM} m`;
    if (!(draughtM >= 0 && draughtM <= 1e4)) return `boat ${boatId}: draught ${draughtM} m`;
  }
  if (new Set(boats.map(({ boatId }) => boatId)).size < boats.length) return "two boats of one id";
  return boats;
}

/** As in the server: the narrower side of the box, and the depth of its particles at rest. */
function boxExtents(particles: ParticleScene | undefined): WaterExtents {
  const { boxSideM = 0, boxWidthM = 0, fillXRatio = 1, fillZRatio = 1, layersCount = 0, count = 0 } = particles ?? {};
  const widthM = boxWidthM > 0 ? boxWidthM : boxSideM;
  const areaM2 = boxSideM * fillXRatio * widthM * fillZRatio;
  return { sideM: Math.min(boxSideM, widthM), longM: Math.max(boxSideM, widthM), depthM: layersCount * Math.sqrt((areaM2 * layersCount) / Math.max(count, 1)) };
}

const kWaterKgpm3 = 1000;

/** As in the server: 2 pi sqrt(sigma / (rho g)). */
function rippleOf(scene: Scene | undefined): Pick<WaterExtents, "rippleM"> {
  const [tensionNpm, gravityMps2] = [finiteAbove0(scene?.wave?.surfaceTensionNpm), finiteAbove0(scene?.gravityMps2)];
  return tensionNpm > 0 && gravityMps2 > 0 ? { rippleM: 2 * Math.PI * Math.sqrt(tensionNpm / (kWaterKgpm3 * gravityMps2)) } : {};
}

function finiteAbove0(value: number | undefined): number {
  return value !== undefined && value > 0 && Number.isFinite(value) ? value : 0;
}

/** As in the server: layers at the spacing of the resting particles. */
function bandOf(scene: Scene | undefined): number {
  if (!scene?.wave || !scene.particles || scene.coupling?.mode === CouplingMode.TWO_WAY) return 0;
  const { patchScale = 1, layersCount = 0, count = 0 } = scene.particles;
  const { sideM, widthM } = readWave(scene.wave);
  const bandM = layersCount * Math.sqrt(sideM * widthM) * patchScale * Math.sqrt(layersCount / Math.max(count, 1));
  return bandM > 0 && bandM < 1e4 ? bandM : 0;
}

/** As in the server: breakers of a wave that makes spray or foam, or that steepens. */
function breaks(scene: Scene | undefined): boolean {
  const hasBreakers = scene?.coupling?.mode === CouplingMode.TWO_WAY || scene?.foam?.surface === true || (scene?.wave?.steepeningRatio ?? 0) > 0;
  return scene?.wave !== undefined && hasBreakers;
}

/** Malformed if a size that clients calculate with is not a positive number. */
export function readGreeting(greeting: Greeting): { greeting: GreetingInfo } | Malformed {
  const scene = greeting.scene;
  const wave = scene?.wave && readWave(scene.wave);
  const sideM = wave?.sideM ?? scene?.particles?.boxSideM ?? 0;
  if (wave && !(wave.depthM > 0 && Number.isFinite(wave.depthM)))
    return malformed(`greeting: wave.depth_m ${wave.depthM} has to be above 0`);
  if (!(sideM > 0 && Number.isFinite(sideM))) return malformed(`greeting: side of the water ${sideM} m has to be above 0`);
  const boats = greeting.boatList ? readBoatList(greeting.boatList) : [];
  if (typeof boats === "string") return malformed(`greeting: ${boats}`);
  return {
    greeting: {
      versionMajor: greeting.version?.major ?? 0,
      versionMinor: greeting.version?.minor ?? 0,
      server: greeting.server,
      device: greeting.device,
      room: greeting.room,
      sessionId: greeting.sessionId.toString(),
      layers: kLayerNames.filter((name) => greeting.layers.includes(kLayers[name])),
      frameRateMaxHz: greeting.limits?.frameRateMaxHz ?? 0,
      serverTimeS: greeting.serverTimeS,
      sceneName: scene?.name ?? "",
      title: scene?.title || scene?.name || greeting.room,
      description: scene?.description ?? "",
      fidelity: fidelityName(scene?.fidelity),
      fidelityLevels: readFidelityLevels(greeting.fidelityLevels),
      setting: scene ? readSetting(scene) : "glassTank",
      waterType: scene ? readWaterType(scene) : "pool",
      firstView: scene && readFirstView(scene),
      wave,
      wind: scene && readWind(scene),
      sideM,
      widthM: wave?.widthM ?? (scene?.particles?.boxWidthM || sideM),
      waterExtents: wave ? { sideM: Math.min(sideM, wave.widthM), longM: Math.max(sideM, wave.widthM), depthM: wave.depthM, ...rippleOf(scene) } : boxExtents(scene?.particles),
      hasParticles: scene?.particles !== undefined,
      bandM: bandOf(scene),
      hasBreakers: breaks(scene),
      gravityMps2: finiteAbove0(scene?.gravityMps2),
      isTwoWay: scene?.coupling?.mode === CouplingMode.TWO_WAY,
      hasBoats: scene?.boats !== undefined,
      hasFloaters: scene?.floaters !== undefined && greeting.layers.includes(kLayers.floaters),
      course: scene?.course && readCourse(scene.course),
      obstacles: scene ? readObstacles(scene) : [],
      beaches: scene ? readBeaches(scene) : [],
      gauges: scene ? readGauges(scene) : [],
      hasBed: scene?.wave !== undefined && scene.bed !== undefined,
      repeats: (scene?.restartAfterS ?? 0) > 0,
      boats,
      scenes: [...greeting.scenes],
      parameters: greeting.parameters
        .filter((p) => [p.min, p.max, p.value].every(Number.isFinite) && p.min < p.max)
        .map(({ path, label, unit, min, max, step, default: fallback, value, help }) => ({
          path, label, unit, min, max, step, default: fallback, value, help,
        })),
      paused: greeting.roomState?.paused ?? false,
      speed: greeting.roomState?.speed ?? 1,
      clockPersonIds: greeting.roomState?.clockPersonIds ?? [],
    },
  };
}
