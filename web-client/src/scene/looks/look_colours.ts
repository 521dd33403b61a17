// The colour map of a look as a texture, and the range of values that it spans, for the materials of look_map.glsl.
import { ClampToEdgeWrapping, DataTexture, LinearFilter, Vector2 } from "three";

import type { Uniforms } from "../shaders/materials";
import { colourMap, kColoursCount } from "./colour_map";
import type { Quantity } from "./looks";
import { RangeFollower, type ValueRange } from "./value_range";

export class LookColours {
  readonly uniforms: Uniforms;
  private readonly texture: DataTexture;
  private readonly follower: RangeFollower | undefined;

  constructor(private readonly quantity: Quantity) {
    this.texture = new DataTexture(colourMap(quantity.map), kColoursCount, 1);
    this.texture.minFilter = this.texture.magFilter = LinearFilter;
    this.texture.wrapS = this.texture.wrapT = ClampToEdgeWrapping;
    this.texture.needsUpdate = true;
    this.follower = typeof quantity.range === "string" ? new RangeFollower(quantity.range === "signed") : undefined;
    this.uniforms = { u_map: { value: this.texture }, u_range: { value: new Vector2() } };
    this.span();
  }

  get range(): ValueRange {
    const { range } = this.quantity;
    return typeof range === "string" ? this.follower!.range : range;
  }

  /** True if the range follows the values: note() wants to know them. */
  get follows(): boolean {
    return this.follower !== undefined;
  }

  /** Takes the magnitude that the values reach now, and the smallest limit that shows more than the steps of the stream. */
  note(reach: number, least: number, nowS: number): void {
    if (this.follower?.note(reach, least, nowS)) this.span();
  }

  dispose(): void {
    this.texture.dispose();
  }

  private span(): void {
    const { low, high } = this.range;
    (this.uniforms["u_range"]!.value as Vector2).set(low, 1 / (high - low));
  }
}
