// A repeating tile of leaves that lie over one another: dark in the gaps, brighter the nearer to the eye.
import { mix } from "../maths/interpolate";
import { makeFastRandom } from "../maths/random";

/** On one tile, from the farthest to the nearest. */
const kLeavesCount = 620;
/** Length of a leaf over the tile's side, at least and at most, and its width over its length. */
const kLengths = [0.07, 0.11] as const;
const kWide = 0.46;
/** Brightness of the gaps, of the farthest leaves, and of the nearest. */
const kGap = 26;
const kFarthest = 70;
const kNearest = 205;
/** By how much leaves differ from one another, and the two halves of one leaf. */
const kUneven = 34;
const kFold = 16;

/** Returns one byte per sample, row by row; the square repeats. */
export function makeLeaves(side: number): Uint8Array<ArrayBuffer> {
  const random = makeFastRandom(77);
  const leaves = new Uint8Array(side * side).fill(kGap);
  for (let n = 0; n < kLeavesCount; ++n) {
    const [x, y, turnRad] = [side * random(), side * random(), 2 * Math.PI * random()];
    const half = 0.5 * side * mix(...kLengths, random());
    const light = mix(kFarthest, kNearest, n / kLeavesCount) + mix(-kUneven, kUneven, random());
    const [cos, sin] = [Math.cos(turnRad), Math.sin(turnRad)];
    const reach = Math.ceil(half);
    for (let dy = -reach; dy <= reach; ++dy)
      for (let dx = -reach; dx <= reach; ++dx) {
        const along = (cos * dx + sin * dy) / half;
        const across = (cos * dy - sin * dx) / (kWide * half);
        // Pointed at both ends.
        if (Math.abs(along) >= 1 || Math.abs(across) >= 1 - along * along) continue;
        const at = ((Math.floor(y) + dy + side) % side) * side + ((Math.floor(x) + dx + side) % side);
        leaves[at] = light + kFold * Math.sign(across) - 0.5 * kFold * Math.abs(along);
      }
  }
  return leaves;
}
