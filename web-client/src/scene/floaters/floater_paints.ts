// Own paints of objects by their ids, so that every page shows the same one in the same colour.
import type { FloaterKindName } from "../../../client/codec/floaters";
import { hash } from "../maths/random";

type Rgb = readonly [red: number, green: number, blue: number];

const kWoods: readonly Rgb[] = [[0.52, 0.35, 0.18], [0.43, 0.27, 0.13], [0.58, 0.42, 0.25], [0.37, 0.29, 0.21], [0.48, 0.38, 0.27]];
const kPaints: Record<FloaterKindName, readonly Rgb[]> = {
  crate: kWoods,
  ball: [[0.72, 0.05, 0.04], [0.03, 0.20, 0.60], [0.02, 0.42, 0.20], [0.85, 0.42, 0.03], [0.40, 0.06, 0.45], [0.02, 0.45, 0.52]],
  barrel: [[0.40, 0.22, 0.10], [0.30, 0.17, 0.08], [0.46, 0.30, 0.16], [0.35, 0.25, 0.17]],
  plank: kWoods,
  duck: [[0.90, 0.62, 0.03], [0.92, 0.66, 0.05], [0.88, 0.56, 0.02]],
  buoy: [[0.68, 0.04, 0.03], [0.74, 0.09, 0.03], [0.60, 0.03, 0.04]],
  raft: [[0.36, 0.25, 0.15], [0.30, 0.20, 0.12], [0.40, 0.30, 0.20]],
  stone: [[0.30, 0.29, 0.28], [0.24, 0.24, 0.25], [0.36, 0.32, 0.27], [0.28, 0.30, 0.29], [0.40, 0.38, 0.35]],
};
const kUneven = 0.12;

/** Writes red, green and blue of an object's paint at `at`. */
export function writePaint(kind: FloaterKindName, floaterId: number, out: Float32Array, at: number): void {
  const paints = kPaints[kind];
  const paint = paints[Math.floor(hash(floaterId, 1, 77) * paints.length)]!;
  const share = 1 + kUneven * (2 * hash(floaterId, 2, 77) - 1);
  for (let k = 0; k < 3; ++k) out[at + k] = paint[k]! * share;
}
