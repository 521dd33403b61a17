// The lamps that shine in the dark: positions, colours and sizes of their glow for one picture, as instances of a quad.
import { BufferAttribute, InstancedBufferAttribute, InstancedBufferGeometry } from "three";

/** More than a room has: 64 boats with 4 lamps, lights of breakwaters with their beams, buoys. The rest is not drawn. */
export const kLampsMax = 352;

export type LampColor = readonly [red: number, green: number, blue: number];

export const kLampColors = {
  red: [1, 0.12, 0.08],
  green: [0.1, 1, 0.35],
  white: [1, 0.93, 0.76],
} as const satisfies Record<string, LampColor>;

export class Lamps {
  readonly geometry = new InstancedBufferGeometry();
  private count = 0;
  /** Position (m), and radius of the glow (m). */
  private readonly at = new InstancedBufferAttribute(new Float32Array(4 * kLampsMax), 4);
  /** Colour, and 1 if the lamp floats: its height is then over the water's surface. */
  private readonly color = new InstancedBufferAttribute(new Float32Array(4 * kLampsMax), 4);
  /** Where a beam ends, from its lamp (m); 0 for a glow. */
  private readonly reach = new InstancedBufferAttribute(new Float32Array(3 * kLampsMax), 3);

  constructor() {
    this.geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]), 3));
    this.geometry.setIndex([0, 1, 2, 2, 1, 3]);
    this.geometry.setAttribute("a_at", this.at);
    this.geometry.setAttribute("a_color", this.color);
    this.geometry.setAttribute("a_reach", this.reach);
  }

  get lampsCount(): number {
    return this.count;
  }

  clear(): void {
    this.count = 0;
  }

  /** `share`: of its full brightness. */
  add(xM: number, yM: number, zM: number, radiusM: number, color: LampColor, share = 1, floats = false): void {
    this.put(xM, yM, zM, radiusM, color, share, floats, 0, 0, 0);
  }

  /** A beam that ends `dx, dy, dz` from its lamp, where it has the radius. */
  addBeam(xM: number, yM: number, zM: number, radiusM: number, color: LampColor, dxM: number, dyM: number, dzM: number): void {
    this.put(xM, yM, zM, radiusM, color, 1, false, dxM, dyM, dzM);
  }

  /** Hands the lamps to the GPU. */
  finish(): void {
    this.geometry.instanceCount = this.count;
    for (const attribute of [this.at, this.color, this.reach]) attribute.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
  }

  private put(xM: number, yM: number, zM: number, radiusM: number, [r, g, b]: LampColor, share: number, floats: boolean, dxM: number, dyM: number, dzM: number): void {
    if (share <= 0 || this.count >= kLampsMax) return;
    this.at.setXYZW(this.count, xM, yM, zM, radiusM);
    this.color.setXYZW(this.count, share * r, share * g, share * b, floats ? 1 : 0);
    this.reach.setXYZ(this.count, dxM, dyM, dzM);
    ++this.count;
  }
}
