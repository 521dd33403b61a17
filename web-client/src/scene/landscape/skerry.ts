// A lighthouse on rocks far outside the water of an open sea without land, so that the eye has something to rest on. Distances are sides of the
// water's square. The server does not know it, and no boat comes so far.
import { Vector3, type BufferGeometry } from "three";

import { MeshBuilder } from "../meshes/mesh_builder";
import { addLighthouse } from "./breakwater_mesh";
import { makeRockGeometry } from "./rock_mesh";

/** Direction from the middle of the water, away from the sun of an afternoon, and distance. */
const kHeadingRad = (-62 * Math.PI) / 180;
const kAwaySides = 2.8;
/** Radius and height of its rocks, and height of its tower. */
const kRadiusSides = 0.3;
const kHighSides = 0.075;
const kTowerSides = 0.22;

/** Returns the rocks and the tower, and where its lamp is. */
export function makeSkerry(sideM: number, depthM: number, plain: boolean): { parts: BufferGeometry[]; lampM: Vector3 } {
  const [xM, zM] = [Math.cos(kHeadingRad), Math.sin(kHeadingRad)].map((share) => share * kAwaySides * sideM) as [number, number];
  const heightM = kHighSides * sideM;
  const rocks = makeRockGeometry({ shape: "rock", xM, zM, radiusM: kRadiusSides * sideM, heightM }, depthM, plain);
  const builder = new MeshBuilder();
  const lampM = addLighthouse(builder, 0, 0, kTowerSides * sideM, plain);
  const tower = builder.build().translate(xM, 0.9 * heightM, zM);
  return { parts: [rocks, tower], lampM: new Vector3(xM, lampM + 0.9 * heightM, zM) };
}
