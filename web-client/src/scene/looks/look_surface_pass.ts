// The water's surface in the colours of a value or with Phong's lighting (look_surface.frag), and its sides where they are seen. Reads the
// field, the look's value or the foam, the sea around, and the depth of the solids. Writes the canvas and its depth.
import { type BufferGeometry, type DataTexture, DoubleSide, FrontSide, Mesh, type RawShaderMaterial, Scene, type Texture, Vector2, Vector3, Vector4 } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { Pass, Picture, Resource } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import { makeGroundTexture } from "../landscape/ground_texture";
import { bedOf, bedUniformValues } from "../landscape/terrain";
import type { Sky } from "../light/sky";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import { makeWaterGeometries } from "../water/water_grid";
import type { LookColours } from "./look_colours";
import type { LookValuePass } from "./look_value_pass";
import { kLeastDepths } from "./surface_values";

/** What colours the surface. */
export type SurfaceColour = { of: "value" | "breaking"; value: LookValuePass; colours: LookColours } | { of: "foam"; foam: Uniforms; colours: LookColours };

/** How the surface looks without a value. */
export interface Paint {
  albedo: readonly [number, number, number];
  shine: number;
}
/** Grey, so that it is not taken for a colour of the bar. */
export const kGreyPaint: Paint = { albedo: [0.16, 0.18, 0.2], shine: 0 };
export const kBluePaint: Paint = { albedo: [0.04, 0.16, 0.28], shine: 0.5 };

interface SurfaceLookInputs {
  sky: Sky;
  field: Texture;
  solids: SolidsPass;
  quality: Quality;
  paint: Paint;
  /** How far below its position the surface is drawn. */
  loweredM: number;
  /** Undefined: no value is shown. */
  colour?: SurfaceColour | undefined;
}

const kDefines = { value: "OF_VALUE", breaking: "OF_BREAKING", foam: "OF_FOAM" } as const;

export class LookSurfacePass implements Pass {
  readonly name = "look surface";
  readonly reads: readonly Resource[];
  readonly writes = ["canvas"] as const;
  private readonly scene = new Scene();
  private readonly meshes: Mesh<BufferGeometry, RawShaderMaterial>[];
  private readonly uniforms: Uniforms;
  private readonly ground: DataTexture | undefined;

  constructor(greeting: GreetingInfo, { sky, field, solids, quality, paint, loweredM, colour }: SurfaceLookInputs) {
    this.reads = ["field", "sea", "solids", ...(colour ? [colour.of === "foam" ? ("foam" as const) : ("lookValue" as const)] : [])];
    const bed = bedOf(greeting);
    const { widthsM, shoreDepthsM } = bedUniformValues(bed);
    this.ground = makeGroundTexture(bed);
    const { edge } = solids.surroundings;
    this.uniforms = {
      ...sky.uniforms,
      ...colour?.colours.uniforms,
      ...(colour && (colour.of === "foam" ? colour.foam : { u_value: { value: colour.value.texture } })),
      ...(edge.kind === "sea" && edge.sea),
      ...(this.ground && { u_ground: { value: this.ground } }),
      u_field: { value: field },
      u_behind_depth: { value: solids.textures.depth },
      u_camera_m: { value: new Vector3() },
      u_resolution: { value: new Vector2(1, 1) },
      u_extent_m: { value: new Vector2(bed.sideM, bed.widthM) },
      u_depth_m: { value: bed.depthM },
      u_beach_width_m: { value: new Vector4(...widthsM) },
      u_shore_depth_m: { value: new Vector4(...shoreDepthsM) },
      u_paint: { value: new Vector3(...paint.albedo) },
      u_shine: { value: paint.shine },
      u_lowered_m: { value: loweredM },
      u_gravity_mps2: { value: greeting.gravityMps2 },
      u_least_depths: { value: kLeastDepths },
    };
    const defines: Record<string, number> = {};
    if (colour) defines[kDefines[colour.of]] = 1;
    if (bed.beaches.length > 0 || this.ground) defines["BEACH"] = 1;
    if (this.ground) defines["GROUND"] = 1;
    if (edge.kind === "sea") defines["OPEN_SEA"] = 1;
    if (loweredM > 0) defines["LOWERED"] = 1;
    const { top, sides } = makeWaterGeometries(edge, quality.surfaceCellsCount, greeting);
    this.meshes = [new Mesh(top, makeMaterial("lookSurface", this.uniforms, { side: DoubleSide, defines }))];
    if (sides) this.meshes.push(new Mesh(sides, makeMaterial("lookSurface", this.uniforms, { side: FrontSide, defines: { ...defines, SKIRT: 1 } })));
    for (const mesh of this.meshes) {
      mesh.frustumCulled = false;
      this.scene.add(mesh);
    }
  }

  draw({ renderer, camera, sizePx }: Picture): void {
    (this.uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    (this.uniforms["u_resolution"]!.value as Vector2).copy(sizePx);
    renderer.setRenderTarget(null);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    for (const mesh of this.meshes) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    this.ground?.dispose();
  }
}
