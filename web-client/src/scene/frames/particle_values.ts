// Values of single particles, from the 12 bytes that the server streams, and the particle under a ray. Pure.
import { kParticleBytes } from "../../../client/codec/frame_types";
import type { ParticleFrame } from "../../net/messages";
import type { Ray } from "./pick";

export const kWordsPerParticle = kParticleBytes / 2;

/** The particles of one picture. */
export interface ShownParticles {
  frame: Pick<ParticleFrame, "count" | "wordMinM" | "wordMaxM" | "maxSpeedMps" | "radiusM">;
  /** As streamed, six u16 per particle. */
  words: Uint16Array;
  /** Time by which they are moved along their velocities. */
  advanceS: number;
}

const signedByte = (byte: number): number => (byte << 24) >> 24;

/** Returns the streamed velocity. */
export function velocityMps({ frame, words }: ShownParticles, index: number): [number, number, number] {
  const at = index * kWordsPerParticle;
  const [low, high] = [words[at + 3]!, words[at + 4]!];
  const unit = frame.maxSpeedMps / 127;
  return [unit * signedByte(low & 255), unit * signedByte(low >> 8), unit * signedByte(high & 255)];
}

export function speedMps(shown: ShownParticles, index: number): number {
  return Math.hypot(...velocityMps(shown, index));
}

/** Returns how white a particle is, 0 to 255. */
export function whiteOf({ words }: ShownParticles, index: number): number {
  return words[index * kWordsPerParticle + 5]! & 255;
}

/** The streamed range of density over rest density. Values beyond it are sent as its ends. */
export const kDensityRatios = { low: 0.5, high: 1.1 };

/** Returns the streamed density over rest density. */
export function densityRatio({ words }: ShownParticles, index: number): number {
  const byte = words[index * kWordsPerParticle + 4]! >> 8;
  return kDensityRatios.low + (byte / 255) * (kDensityRatios.high - kDensityRatios.low);
}

/** Returns where a particle is drawn. */
export function placeM(shown: ShownParticles, index: number): [number, number, number] {
  const { wordMinM, wordMaxM } = shown.frame;
  const at = index * kWordsPerParticle;
  // The order on the wire is x, z, y.
  const share = [shown.words[at]! / 65535, shown.words[at + 2]! / 65535, shown.words[at + 1]! / 65535];
  const velocity = velocityMps(shown, index);
  return [0, 1, 2].map((axis) => wordMinM[axis]! + (wordMaxM[axis]! - wordMinM[axis]!) * share[axis]! + velocity[axis]! * shown.advanceS) as [number, number, number];
}

/** Calls `visit` with every `stride`-th particle and where it is drawn, m. Makes no objects: there may be hundreds of thousands. */
export function forEachPlace({ frame, words, advanceS }: ShownParticles, stride: number, visit: (index: number, xM: number, yM: number, zM: number) => void): void {
  const { wordMinM, wordMaxM } = frame;
  const [minX, minY, minZ] = wordMinM;
  const [perX, perY, perZ] = [0, 1, 2].map((axis) => (wordMaxM[axis]! - wordMinM[axis]!) / 65535) as [number, number, number];
  const advance = (advanceS * frame.maxSpeedMps) / 127;
  for (let index = 0; index < frame.count; index += stride) {
    const at = index * kWordsPerParticle;
    const low = words[at + 3]!;
    // The order on the wire is x, z, y.
    visit(index, minX + perX * words[at]! + advance * signedByte(low & 255), minY + perY * words[at + 2]! + advance * signedByte(low >> 8), minZ + perZ * words[at + 1]! + advance * signedByte(words[at + 4]! & 255));
  }
}

/** Returns the first particle whose sphere the ray meets within `farM`; undefined if it meets no sphere. */
export function pickParticle({ originM, direction }: Ray, shown: ShownParticles, farM = Infinity): number | undefined {
  const { radiusM } = shown.frame;
  const [ox, oy, oz] = originM;
  const [dx, dy, dz] = direction;
  let nearestM = farM;
  let found: number | undefined;
  forEachPlace(shown, 1, (index, xM, yM, zM) => {
    const [x, y, z] = [xM - ox, yM - oy, zM - oz];
    const alongM = x * dx + y * dy + z * dz;
    const inside2 = radiusM * radiusM - (x * x + y * y + z * z - alongM * alongM);
    if (inside2 < 0) return;
    const hitM = alongM - Math.sqrt(inside2);
    if (hitM > 0 && hitM < nearestM) {
      nearestM = hitM;
      found = index;
    }
  });
  return found;
}
