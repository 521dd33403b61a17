// What of a sound reaches the camera: level by distance, direction, and the high frequencies that the air takes. Pure.
import { clamp } from "../scene/maths/interpolate";

/** Level of a source over the square root of its area per distance: what is as large and as far in a tank and at sea sounds as loud. */
const kLoudness = 6;
/** Attenuation in air grows with about the square of the frequency: 76.6 dB/km at 8 kHz (ISO 9613-2, table 2, at 20 C and 70 %). */
const kAirDbPerMHz2 = 76.6e-3 / 8000 ** 2;
const kCutoffDb = 3;
const kCutoffsHz = [200, 18_000] as const;

export interface Listener {
  xM: number;
  yM: number;
  zM: number;
  /** Unit vector to the right of the picture. */
  rightX: number;
  rightY: number;
  rightZ: number;
  /** Below the surface. */
  isUnder: boolean;
}

/** How a source is heard. */
export interface Heard {
  /** 0 to 1. */
  level: number;
  /** -1 left to 1 right. */
  pan: number;
  /** The air takes what is above. */
  cutoffHz: number;
}

/** Writes to `heard` how a source of `areaM2` of agitated water is heard. */
export function hear(listener: Listener, xM: number, yM: number, zM: number, areaM2: number, heard: Heard): void {
  const dx = xM - listener.xM;
  const dy = yM - listener.yM;
  const dz = zM - listener.zM;
  const sizeM = Math.sqrt(Math.max(areaM2, 0));
  const distanceM = Math.max(Math.hypot(dx, dy, dz), sizeM, 1e-3);
  heard.level = Math.min((kLoudness * sizeM) / distanceM, 1);
  heard.pan = clamp((dx * listener.rightX + dy * listener.rightY + dz * listener.rightZ) / distanceM, -1, 1);
  heard.cutoffHz = clamp(Math.sqrt(kCutoffDb / (kAirDbPerMHz2 * distanceM)), ...kCutoffsHz);
}
