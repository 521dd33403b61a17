// The greeting as plain data that survives postMessage: what the page needs of the scene, no Protobuf objects.
import { Boundary } from "../gen/spindrift/v1/scene_pb";
import { Layer, type Greeting } from "../gen/spindrift/v1/wire_pb";
import type { ParsedMessage } from "./parse";

/** Major version of the wire that this client speaks. */
export const kWireMajor = 1;
export const kWireMinor = 0;

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

export interface WaveInfo {
  resolutionCount: number;
  sideM: number;
  depthM: number;
  periodic: boolean;
}

export interface GreetingInfo {
  versionMajor: number;
  versionMinor: number;
  server: string;
  device: string;
  room: string;
  sessionId: string;
  layers: ("surface" | "particles" | "diagnostics")[];
  frameRateMaxHz: number;
  title: string;
  description: string;
  /** Absent where the scene has no heightfield. */
  wave: WaveInfo | undefined;
  /** Horizontal side of the water, metres. */
  sideM: number;
  hasParticles: boolean;
  parameters: ParameterInfo[];
  paused: boolean;
  speed: number;
}

/** A greeting's plain form, or "malformed" where a size that the page draws with is not a positive number. */
export function readGreeting(greeting: Greeting): ParsedMessage {
  const scene = greeting.scene;
  const wave = scene?.wave;
  const waveInfo = wave && {
    resolutionCount: wave.resolutionCount ?? 0,
    sideM: wave.sideM ?? 0,
    depthM: wave.depthM ?? 0,
    periodic: wave.boundary !== Boundary.WALL,
  };
  const sideM = waveInfo?.sideM ?? scene?.particles?.boxSideM ?? 0;
  if (waveInfo && !(waveInfo.depthM > 0 && Number.isFinite(waveInfo.depthM)))
    return { kind: "malformed", reason: `greeting: wave.depth_m ${waveInfo.depthM} has to be above 0` };
  if (!(sideM > 0 && Number.isFinite(sideM)))
    return { kind: "malformed", reason: `greeting: side of the water ${sideM} m has to be above 0` };
  const layers: GreetingInfo["layers"] = [];
  if (greeting.layers.includes(Layer.SURFACE)) layers.push("surface");
  if (greeting.layers.includes(Layer.PARTICLES)) layers.push("particles");
  if (greeting.layers.includes(Layer.DIAGNOSTICS)) layers.push("diagnostics");
  return {
    kind: "greeting",
    greeting: {
      versionMajor: greeting.version?.major ?? 0,
      versionMinor: greeting.version?.minor ?? 0,
      server: greeting.server,
      device: greeting.device,
      room: greeting.room,
      sessionId: greeting.sessionId.toString(),
      layers,
      frameRateMaxHz: greeting.limits?.frameRateMaxHz ?? 0,
      title: scene?.title || scene?.name || greeting.room,
      description: scene?.description ?? "",
      wave: waveInfo,
      sideM,
      hasParticles: scene?.particles !== undefined,
      parameters: greeting.parameters
        .filter((p) => [p.min, p.max, p.value].every(Number.isFinite) && p.min < p.max)
        .map(({ path, label, unit, min, max, step, default: fallback, value, help }) => ({
          path, label, unit, min, max, step, default: fallback, value, help,
        })),
      paused: greeting.roomState?.paused ?? false,
      speed: greeting.roomState?.speed ?? 1,
    },
  };
}
