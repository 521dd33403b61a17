// Gauges as slender poles, graduated from the bed to above the water; one mesh for all.
import { Mesh, type BufferGeometry, type Material } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { GaugeInfo } from "../../../client/codec/scene_info";
import { bedOf, depthAtM } from "../landscape/terrain";
import { castsShadow } from "../meshes/casters";
import { MeshBuilder, type Paint } from "../meshes/mesh_builder";

/** Half the width of a pole, as a share of the mean side of the water. */
const kHalfWidth = 0.003;
/** Height over the still water: this share of the depth, and at most that of the narrower side. */
const kHeadDepths = 0.4;
const kHeadSides = 0.2;
/** Least height of a band of one colour, in half widths, and most bands of a pole. */
const kBandHalfWidths = 3;
const kMostBands = 60;

const kLight: Paint = [0.86, 0.87, 0.85, 0];
const kRed: Paint = [0.7, 0.07, 0.05, 0];

/** `lowM` and `topM`: heights over the still water. */
export interface Pole extends GaugeInfo {
  lowM: number;
  topM: number;
}

/** Returns a pole for each gauge. One on land stands on the ground. */
export function polesOf(greeting: GreetingInfo, gauges: readonly GaugeInfo[]): Pole[] {
  const { sideM, depthM } = greeting.waterExtents;
  const headM = Math.min(kHeadDepths * depthM, kHeadSides * sideM);
  const bed = bedOf(greeting);
  return gauges.map((gauge) => {
    const lowM = -depthAtM(bed, gauge.xM, gauge.zM);
    return { ...gauge, lowM, topM: Math.max(lowM, 0) + headM };
  });
}

/** Returns the height of a band: 1, 2 or 5 times a power of ten, and at least `leastM`. */
export function bandHeightM(leastM: number): number {
  const decade = 10 ** Math.floor(Math.log10(leastM));
  return decade * ([1, 2, 5].find((factor) => factor * decade >= leastM * (1 - 1e-9)) ?? 10);
}

/** A border of bands is at the still water. */
function makeGeometry(poles: readonly Pole[], halfM: number): BufferGeometry {
  const builder = new MeshBuilder();
  for (const { xM, zM, lowM, topM } of poles) {
    const heightM = bandHeightM(Math.max(kBandHalfWidths * halfM, (topM - lowM) / kMostBands));
    const size = { halfX: halfM, halfZ: halfM };
    for (let n = Math.floor(lowM / heightM); n * heightM < topM; ++n)
      builder.block(xM, zM, { yM: Math.max(n * heightM, lowM), ...size }, { yM: Math.min((n + 1) * heightM, topM), ...size }, n % 2 === 0 ? kRed : kLight);
  }
  return builder.build();
}

export class GaugePoles {
  readonly mesh: Mesh;
  poles: readonly Pole[] = [];

  constructor(
    private readonly greeting: GreetingInfo,
    material: Material,
  ) {
    this.mesh = new Mesh(makeGeometry([], 1), material);
    this.mesh.frustumCulled = false;
    castsShadow(this.mesh);
  }

  show(gauges: readonly GaugeInfo[]): void {
    const { sideM, widthM } = this.greeting;
    this.poles = polesOf(this.greeting, gauges);
    this.mesh.geometry.dispose();
    this.mesh.geometry = makeGeometry(this.poles, kHalfWidth * Math.sqrt(sideM * widthM));
    this.mesh.visible = gauges.length > 0;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
  }
}
