// A boat as triangles: its hull with all that it carries, and its lid, a surface over everything inside the gunwale.
import type { BufferGeometry } from "three";

import type { BoatDetail } from "../../../client/codec/greeting";
import { MeshBuilder, type Point } from "../meshes/mesh_builder";
import { addFittings, launchSoleM, type BoatLamp, type Detail } from "./fittings";
import { HullLines, kLowestAt } from "./lines";
import { liveryOf, type BoatColors, type Livery } from "./livery";
import { addInside, addOutside, mirrored, stationsOf, type Floor } from "./shell";

/** Stations along the hull, and rows of its bottom. */
const kStations = { full: { stationsCount: 25, rowsCount: 5 }, plain: { stationsCount: 10, rowsCount: 2 } };
const kDetails: Record<"full" | "plain", Detail> = { full: { sidesCount: 14, isFine: true }, plain: { sidesCount: 6, isFine: false } };
/** Where a launch's cockpit ends and its foredeck begins. */
const kBulkheadAt = 0.48;

interface BoatParts {
  hull: BufferGeometry;
  lid: BufferGeometry;
  lamps: BoatLamp[];
}

function floorsOf(lines: HullLines, livery: Livery): Floor[] {
  const { kind, boat } = lines;
  if (kind === "dinghy") return [{ from: 0, to: 1, heightM: () => -0.3 * boat.heightM, paint: livery.deck, camber: 0 }];
  if (kind === "cutter") return [{ from: 0, to: 1, heightM: (along) => lines.deckM(along), paint: livery.deck, camber: 0.05 }];
  return [
    { from: 0, to: kBulkheadAt, heightM: () => launchSoleM(lines), paint: livery.deck, camber: 0 },
    { from: kBulkheadAt, to: 1, heightM: (along) => lines.deckM(along) - 0.05 * boat.heightM, paint: livery.deck, camber: 0.1 },
  ];
}

/** Adds the hull alone: a closed surface. Returns the gunwale's inner edge to starboard, from stern to stem. */
export function addShell(builder: MeshBuilder, lines: HullLines, livery: Livery, plain: boolean): Point[] {
  const { stationsCount, rowsCount } = plain ? kStations.plain : kStations.full;
  const floors = floorsOf(lines, livery);
  const stations = stationsOf(lines, stationsCount);
  for (const along of [kLowestAt, ...floors.map(({ from }) => from)]) if (!stations.includes(along)) stations.push(along);
  stations.sort((a, b) => a - b);
  const edge = addOutside(builder, lines, livery, stations, rowsCount);
  return addInside(builder, lines, livery, stations, edge, floors);
}

/** `colors` undefined: nobody owns the boat. */
export function makeBoatParts(boat: BoatDetail, colors: BoatColors | undefined, plain: boolean): BoatParts {
  const lines = new HullLines(boat);
  const livery = liveryOf(lines.kind, boat.boatId, colors);
  const builder = new MeshBuilder();
  const rim = addShell(builder, lines, livery, plain);
  const lamps = addFittings(builder, lines, livery, plain ? kDetails.plain : kDetails.full);
  const lid = new MeshBuilder().grid([rim, rim.map(mirrored)], livery.deck).build();
  return { hull: builder.build(), lid, lamps };
}
