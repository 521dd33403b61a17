// Finds a position for a new boat: deep enough, and clear of obstacles and other boats. Pure.
import type { GreetingInfo } from "../../client/codec/greeting";
import { clearanceM } from "../scene/landscape/clearance";
import { bedOf, depthAtM, type Bed } from "../scene/landscape/terrain";

const kTriesCount = 160;
/** The golden angle: candidates fill the water evenly from where they begin. */
const kTurnRad = Math.PI * (3 - Math.sqrt(5));

/** Returns the free position nearest to `from`, otherwise the middle, for a hull of `lengthM`; if none is free, the candidate with the most room. */
export function spawnPlace(
  greeting: Pick<GreetingInfo, "sideM" | "widthM" | "waterExtents" | "beaches" | "obstacles">,
  lengthM: number,
  draughtM: number,
  others: readonly { xM: number; zM: number }[],
  from = { xM: 0, zM: 0 },
): { xM: number; zM: number } {
  const bed: Bed = bedOf(greeting);
  const [halfX, halfZ] = [greeting.sideM / 2, greeting.widthM / 2];
  const wantedM = 0.75 * lengthM;
  let best = from;
  let bestM = -Infinity;
  for (let i = 0; i < kTriesCount; ++i) {
    const out = 0.97 * Math.sqrt(i / kTriesCount);
    const xM = from.xM + out * (halfX + Math.abs(from.xM)) * Math.cos(i * kTurnRad);
    const zM = from.zM + out * (halfZ + Math.abs(from.zM)) * Math.sin(i * kTurnRad);
    if (Math.abs(xM) >= halfX || Math.abs(zM) >= halfZ) continue;
    let freeM = Math.min(halfX - Math.abs(xM), halfZ - Math.abs(zM));
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
