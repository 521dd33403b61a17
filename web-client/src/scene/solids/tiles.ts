// Tiles and slabs with joints (tiles.frag): floor, walls and deck of a pool, floor of a tank.
import { Vector2, type RawShaderMaterial } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import { makeMaterial } from "../shaders/materials";
import type { SurroundingsContext } from "./surroundings_context";

/** `deck`: of natural stone, wet where water splashes on it. Returns a material for geometries whose fourth number of a colour is the side of a tile, in sides of the water. The caller disposes it. */
export function makeTiles({ sideM, widthM }: Pick<GreetingInfo, "sideM" | "widthM">, { sky, noise, field, caustics, shadow, quality }: SurroundingsContext, deck?: "wet" | "dry"): RawShaderMaterial {
  const uniforms = {
    ...sky.uniforms,
    ...caustics,
    ...shadow,
    u_noise: { value: noise },
    u_field: { value: field ?? null },
    u_extent_m: { value: new Vector2(sideM, widthM) },
    u_half_m: { value: new Vector2(sideM / 2, widthM / 2) },
    u_level_m: { value: 0 },
    u_has_water: { value: (field ?? caustics) !== undefined },
  };
  return makeMaterial("tiles", uniforms, { defines: { ...(quality.plain ? { PLAIN: 1 } : deck && { DECK: 1 }), ...(deck === "wet" && { WET: 1 }), ...(caustics && { CAUSTICS: 1 }), ...(shadow && { SHADOWS: 1 }) } });
}
