// A lighthouse on rocks and a sailing boat, far outside the water of an open sea without land, so that the eye has something to rest on.
// Distances are sides of the water's square. The server does not know them, and no boat comes so far.
import { Vector3, type BufferGeometry } from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

import { MeshBuilder, type Paint, type Point } from "../meshes/mesh_builder";
import { addRod } from "../meshes/shapes";
import { addLighthouse } from "./breakwater_mesh";
import { makeRockGeometry } from "./rock_mesh";

/** The lighthouse: direction from the middle of the water, away from the sun of an afternoon, and distance; radius and height of its rocks, height of its tower. */
const kHeadingRad = (-62 * Math.PI) / 180;
const kAwaySides = 2.8;
const kRadiusSides = 0.3;
const kHighSides = 0.075;
const kTowerSides = 0.22;
/** The sailing boat: direction and distance, height of its mast, and how far the wind heels it. */
const kSailHeadingRad = (-101 * Math.PI) / 180;
const kSailAwaySides = 2.2;
const kMastSides = 0.16;
const kHeelRad = 0.12;

const kHull: Paint = [0.10, 0.12, 0.16, 0];
const kSail: Paint = [0.86, 0.84, 0.78, 0.1];
const kMast: Paint = [0.3, 0.2, 0.12, 0.2];

/** Returns a sloop with the wind from its side: lengths are heights of its mast, the bow is along +x. */
function makeSloop(): BufferGeometry {
  const builder = new MeshBuilder();
  const hull = [[-0.06, 0.3, 0.05], [0.1, 0.4, 0.12]].map(([y, x, z]): Point[] => [[-x!, y!, 0.8 * z!], [0, y!, z!], [0.6 * x!, y!, 0.6 * z!], [1.1 * x!, y! * 1.15, 0], [0.6 * x!, y!, -0.6 * z!], [0, y!, -z!], [-x!, y!, -0.8 * z!], [-x!, y!, 0.8 * z!]]);
  builder.grid(hull, kHull);
  builder.grid([hull[1]!, hull[1]!.map((): Point => [0, 0.11, 0])], kMast);
  addRod(builder, [0.08, 0.1, 0], [0.08, 1, 0], 0.008, kMast, 4);
  // Each from its luff to its leech; the wind fills it toward +z.
  for (const [luff, leech, head] of [[[0.07, 0.2], [-0.36, 0.22], [0.06, 0.97]], [[0.42, 0.13], [0.12, 0.17], [0.11, 0.82]]] as const) {
    const rows = [0, 0.3, 0.6, 0.85, 1].map((up) => [0, 0.33, 0.67, 1].map((across): Point => {
      const foot = [0, 1].map((k) => luff[k]! + (leech[k]! - luff[k]!) * across);
      const fullness = 0.09 * Math.sin(Math.PI * (0.15 + 0.7 * across)) * (1 - up) + 0.1 * across * (1 - up);
      return [foot[0]! + (head[0] - foot[0]!) * up, foot[1]! + (head[1] - foot[1]!) * up, fullness];
    }));
    builder.grid(rows, kSail);
    builder.grid(rows.map((row) => [...row].reverse()), kSail);
  }
  return builder.build();
}

/** Returns the rocks, the tower and the boat, and where the tower's lamp is. */
export function makeSkerry(sideM: number, depthM: number, plain: boolean): { geometry: BufferGeometry; lampM: Vector3 } {
  const [xM, zM] = [Math.cos(kHeadingRad), Math.sin(kHeadingRad)].map((share) => share * kAwaySides * sideM) as [number, number];
  const heightM = kHighSides * sideM;
  const rocks = makeRockGeometry({ shape: "rock", xM, zM, radiusM: kRadiusSides * sideM, heightM }, depthM, plain);
  const builder = new MeshBuilder();
  const lampM = addLighthouse(builder, 0, 0, kTowerSides * sideM, plain);
  const tower = builder.build().translate(xM, 0.9 * heightM, zM);
  const mastM = kMastSides * sideM;
  const sloop = makeSloop().rotateX(kHeelRad).scale(mastM, mastM, mastM).rotateY(0.5);
  sloop.translate(Math.cos(kSailHeadingRad) * kSailAwaySides * sideM, 0, Math.sin(kSailHeadingRad) * kSailAwaySides * sideM);
  const geometry = mergeGeometries([rocks, tower, sloop].map((part) => (part.index ? part.toNonIndexed() : part)));
  return { geometry, lampM: new Vector3(xM, lampM + 0.9 * heightM, zM) };
}
