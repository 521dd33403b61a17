// How far the surface is from rest, over the water alone: the values that a range follows. Pure.
import type { GreetingInfo } from "../../../client/codec/greeting";
import { isCovered } from "../landscape/clearance";
import { bedOf, depthAtM } from "../landscape/terrain";
import { kLeastDepths, type ShownSurface } from "./surface_values";

const kPerSide = 64;

/**
 * Returns the magnitudes of elevation or rate at positions spread over the water. Positions on land, under a film of water (less than kLeastDepths
 * of the scene's depth) and in obstacles do not count: there the elevation is that of the ground.
 */
export function waterMagnitudes(surface: ShownSurface, greeting: Parameters<typeof bedOf>[0] & Pick<GreetingInfo, "obstacles">, of: "elevation" | "rate"): Float64Array {
  const bed = bedOf(greeting);
  const magnitudes = new Float64Array(kPerSide ** 2);
  const place = (i: number, alongM: number): number => ((i + 0.5) / kPerSide - 0.5) * alongM;
  let count = 0;
  for (let at = 0; at < magnitudes.length; ++at) {
    const [xM, zM] = [place(at % kPerSide, bed.sideM), place(Math.floor(at / kPerSide), bed.widthM)];
    const elevationM = surface.elevationM(xM, zM);
    if (elevationM + depthAtM(bed, xM, zM) <= kLeastDepths * bed.depthM || isCovered(greeting.obstacles, xM, zM)) continue;
    magnitudes[count++] = Math.abs(of === "elevation" ? elevationM : surface.rateMps(xM, zM));
  }
  return magnitudes.subarray(0, count);
}
