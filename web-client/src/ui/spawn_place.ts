// Finds a place for a new boat: deep enough, and clear of obstacles and other boats. Pure.
import type { GreetingInfo } from "../codec/greeting";
import { clearanceM } from "../scene/clearance";
import { bedOf, depthAtM, type Bed } from "../scene/terrain";

const kTriesCount = 160;
/** The golden angle: candidates fill the square evenly from the middle outward. */
const kTurnRad = Math.PI * (3 - Math.sqrt(5));

/** Returns the free place nearest to the middle for a hull of `lengthM`; if none is free, the candidate with the most room. */
export function spawnPlace(
  greeting: Pick<GreetingInfo, "sideM" | "waterExtents" | "beaches" | "obstacles">,
  lengthM: number,
  draughtM: number,
  others: readonly { xM: number; zM: number }[],
): { xM: number; zM: number } {
  const bed: Bed = bedOf(greeting);
  const half = greeting.sideM / 2;
  const wantedM = 0.75 * lengthM;
  let best = { xM: 0, zM: 0 };
  let bestM = -Infinity;
  for (let i = 0; i < kTriesCount; ++i) {
    const outM = 0.97 * half * Math.sqrt(i / kTriesCount);
    const xM = outM * Math.cos(i * kTurnRad);
    const zM = outM * Math.sin(i * kTurnRad);
    let freeM = Math.min(half - Math.abs(xM), half - Math.abs(zM));
    for (const obstacle of greeting.obstacles) freeM = Math.min(freeM, clearanceM(obstacle, xM, zM));
    for (const other of others) freeM = Math.min(freeM, Math.hypot(xM - other.xM, zM - other.zM) - wantedM);
    if (depthAtM(bed, xM, zM) < 1.3 * draughtM) freeM = Math.min(freeM, -lengthM);
    if (freeM <= bestM) continue;
    best = { xM, zM };
    bestM = freeM;
    if (freeM >= wantedM) break;
  }
  return best;
}
