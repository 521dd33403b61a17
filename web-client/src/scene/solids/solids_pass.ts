// Everything but water: the sky, what is around the water, boats, buoys, gauges and objects. Reads the field, for buoys, the shore, the caustics, the shadow, and the
// frames of boats and objects.
// Writes the solids' colour (linear light) and depth; in the plain tiers, where a room has a wave, the canvas instead, and the textures only for
// passes that need them.
import { Color, DepthTexture, Mesh, Scene, SRGBColorSpace, UnsignedIntType, Vector2, Vector3, WebGLRenderTarget, type RawShaderMaterial, type Texture, type WebGLRenderer } from "three";

import type { GameInfo } from "../../../client/codec/game";
import type { BoatDetail, GreetingInfo } from "../../../client/codec/greeting";
import type { GaugeInfo } from "../../../client/codec/scene_info";
import { Boats } from "../boats/boats";
import { buoyPlaces, Buoys } from "../boats/buoys";
import { CourseMarks } from "../boats/course_marks";
import type { BoatColors } from "../boats/livery";
import type { Pass, Picture } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import type { WarmUp } from "../drawing/warm_up";
import { Floaters } from "../floaters/floaters";
import type { BodyPose } from "../../../client/codec/bodies";
import type { FloaterPose } from "../../../client/codec/floaters";
import type { StreamedFrames } from "../frames/streamed_frames";
import { kTankTile } from "../landscape/paints";
import { bedOf, isTank } from "../landscape/terrain";
import type { Lamps } from "../light/lamps";
import type { Sky } from "../light/sky";
import { hazeM } from "../light/weather";
import { displayed } from "../light/light";
import { clamp } from "../maths/interpolate";
import { MeshBuilder } from "../meshes/mesh_builder";
import type { OpenSea } from "../sea/open_sea";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import { GaugePoles, type Pole } from "./gauge_poles";
import { Surroundings } from "./surroundings";

/** Size of the grain on stone and sand: a share of the side within bounds. */
const kGrainSides = 1 / 16;
const kGrainLimitsM = [0.5, 4] as const;
/** Stone is wet up to this share of the depth above the still water. */
const kWetDepths = 0.08;

const kFloors: Record<GreetingInfo["setting"], readonly [number, number, number]> = {
  openSea: [0.224, 0.205, 0.156],
  pool: [0.34, 0.63, 0.69],
  flume: kTankTile,
  glassTank: kTankTile,
};

/** Where a picture has the solids: in the textures, for passes that look through or around them, or on the canvas, for the display. */
export const kInTextures = "textures";
export const kOnCanvas = "canvas";
type SolidsUse = typeof kInTextures | typeof kOnCanvas;

interface LitBy {
  caustics: Uniforms | undefined;
  shadow: Uniforms | undefined;
  shore: Uniforms | undefined;
}

export class SolidsPass implements Pass {
  readonly name = "solids";
  readonly reads = ["frames", "field", "shore", "caustics", "shadow"] as const;
  readonly writes = ["solids"] as const;
  readonly surroundings: Surroundings;
  readonly target: WebGLRenderTarget;
  /** The uniform of the lamps: 0 by day, 1 at night. */
  readonly darkness = { value: 0 };
  private readonly haze = { value: 0 };
  readonly scene = new Scene();
  /** Chooses where a picture needs the solids. */
  use: (picture: Picture) => SolidsUse = () => kInTextures;
  /** Light of the level bed of an open sea, which the plain tiers do not draw. */
  readonly bedLight = new Vector3();
  /** What was drawn last. */
  used: SolidsUse = kInTextures;
  private readonly bedColor = new Color();
  private isEmpty = false;
  /** Albedo of the floor, on average. */
  readonly floorAlbedo = new Vector3();
  /** Uniforms of caustics.glsl, shadow.glsl and shore.glsl; undefined where the scene does not have them. */
  readonly sunlight: LitBy;
  private readonly material: RawShaderMaterial;
  private readonly materials: RawShaderMaterial[] = [];
  private readonly boats: Boats | undefined;
  private readonly buoys: Buoys | undefined;
  private readonly floaters: Floaters | undefined;
  private readonly course: CourseMarks | undefined;
  private readonly gauges: GaugePoles;

  /** `greeting` is read in every picture, because its wind changes. `field` undefined: the room has no wave. */
  constructor(
    private readonly greeting: GreetingInfo,
    private readonly sky: Sky,
    noise: Texture,
    field: Texture | undefined,
    sunlight: LitBy,
    sea: OpenSea | undefined,
    private readonly frames: Pick<StreamedFrames, "bodies" | "floaters">,
    quality: Quality,
    warmUp: WarmUp,
  ) {
    const { sideM, widthM } = greeting;
    this.floorAlbedo.set(...kFloors[greeting.setting]);
    const { caustics, shadow, shore } = (this.sunlight = sunlight);
    const [leastM, mostM] = kGrainLimitsM;
    const uniforms = {
      ...sky.uniforms,
      ...caustics,
      ...shadow,
      ...shore,
      u_camera_m: { value: new Vector3() },
      u_field: { value: field ?? null },
      u_noise: { value: noise },
      u_extent_m: { value: new Vector2(sideM, widthM) },
      u_grain_m: { value: clamp(kGrainSides * Math.max(sideM, widthM), leastM, mostM) },
      u_wet_m: { value: kWetDepths * bedOf(greeting).depthM },
      u_haze_m: this.haze,
      u_darkness: this.darkness,
    };
    const defines = { ...(quality.plain && { PLAIN: 1, VERTEX_LIT: 1 }), ...(isTank(greeting) ? { TANK: 1 } : field && !quality.plain && { FIELD: 1 }), ...(caustics && { CAUSTICS: 1 }), ...(shadow && { SHADOWS: 1 }), ...(shore && { SHORE: 1 }) };
    const make = (more?: Record<string, number>, colorWrite = true): RawShaderMaterial => {
      const material = makeMaterial(quality.plain ? "solidPlain" : "solid", uniforms, { defines: { ...defines, ...more }, colorWrite });
      this.materials.push(material);
      return material;
    };
    this.material = make();
    const lid = greeting.hasBoats ? make({}, false) : undefined;
    const block = new MeshBuilder().block(0, 0, { yM: 0, halfX: 1, halfZ: 1 }, { yM: 1, halfX: 1, halfZ: 1 }, [1, 1, 1, 1]).build();
    warmUp([sky.dome, ...this.materials.map((material) => new Mesh(block, material))]);
    block.dispose();
    this.surroundings = new Surroundings(greeting, { sky, noise, field, caustics, shadow, sea, haze: this.haze, solid: this.material, quality });
    this.gauges = new GaugePoles(greeting, this.material);
    this.scene.add(sky.dome, ...this.surroundings.solids, this.gauges.mesh);
    if (lid) {
      this.boats = new Boats(this.scene, this.material, lid, quality.plain);
      this.boats.setBoats(greeting.boats);
    }
    if (greeting.hasFloaters) this.floaters = new Floaters(this.scene, make({ INSTANCES: 1 }), greeting, quality.plain);
    if (field) {
      const floating = make({ FLOATS: 1 });
      this.buoys = new Buoys(buoyPlaces(greeting), floating, quality.plain);
      this.scene.add(this.buoys.group);
      if (greeting.course) {
        this.course = new CourseMarks(greeting.course, floating, quality.plain);
        this.scene.add(this.course.group);
      }
    }
    const samples = quality.samplesCount > 1 ? quality.samplesCount : 0;
    this.target = new WebGLRenderTarget(1, 1, { type: quality.texelType, samples });
    this.target.depthTexture = new DepthTexture(1, 1, UnsignedIntType);
  }

  /** For the passes that look through water. */
  get textures(): { color: Texture; depth: Texture } {
    return { color: this.target.texture, depth: this.target.depthTexture! };
  }

  setBoats(boats: readonly BoatDetail[]): void {
    this.boats?.setBoats(boats);
  }

  private get isOpenSea(): boolean {
    return this.greeting.setting === "openSea";
  }

  setGauges(gauges: readonly GaugeInfo[]): void {
    this.gauges.show(gauges);
  }

  drawnGauges(): readonly Pole[] {
    return this.gauges.poles;
  }

  /** Shows what belongs to a game, and highlights the mark of the course that one's own boat has to round. */
  setGame(kind: GameInfo["kind"] | undefined, nextMark: number | undefined): void {
    this.course?.setGame(kind, nextMark);
  }

  /** `colors`: of the owners and their teams, by boat. */
  setOwnerColors(colors: ReadonlyMap<number, BoatColors>): void {
    this.boats?.setOwnerColors(colors);
  }

  /** Adds the lamps that are seen from the camera. Call it after draw(). */
  collectLamps(lamps: Lamps, cameraM: Vector3, shownS: number): void {
    this.boats?.collectLamps(lamps, cameraM);
    this.buoys?.collectLamps(lamps, shownS);
    this.surroundings.collectLamps(lamps, shownS);
  }

  poseOf(boatId: number): BodyPose | undefined {
    return this.boats?.poseOf(boatId);
  }

  drawnBoats(): BodyPose[] {
    return this.boats?.drawn() ?? [];
  }

  /** Returns the objects in the water as they are drawn now. The next picture overwrites them. */
  drawnFloaters(): FloaterPose[] {
    return this.floaters?.drawn() ?? [];
  }

  /** Moves boats and objects to where they are at a time of the scene. */
  place(shownS: number | undefined): void {
    const bodies = this.boats && shownS !== undefined ? this.frames.bodies.around(shownS) : undefined;
    if (bodies) this.boats!.show(bodies.from, bodies.to, bodies.mix);
    if (this.boats) this.buoys?.pushAside(this.boats.hulls());
    const floaters = this.floaters && shownS !== undefined ? this.frames.floaters.around(shownS) : undefined;
    if (floaters) this.floaters!.show(floaters.from, floaters.to, floaters.mix);
  }

  /** Draws into the textures again. */
  resetUse(): void {
    this.use = () => kInTextures;
  }

  /** The colour behind everything on the canvas; in the plain tiers that of the level bed. */
  get backdrop(): Color {
    const { u_sun_light, u_ambient_up, u_exposure } = this.sky.uniforms;
    const { bedLight, bedColor } = this;
    bedLight.copy(u_sun_light!.value as Vector3).multiplyScalar(1.25 * this.sky.sunDirection.y).add(u_ambient_up!.value as Vector3).multiply(this.floorAlbedo);
    return bedColor.setRGB(...displayed(bedLight, u_exposure!.value as number), SRGBColorSpace);
  }

  draw(picture: Picture): void {
    const { renderer, camera, sizePx, shownS } = picture;
    this.place(shownS);
    this.haze.value = isTank(this.greeting) ? 0 : hazeM(this.greeting);
    this.sky.follow(camera);
    this.surroundings.look(camera.position);
    (this.material.uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    this.used = this.use(picture);
    if (this.used === kInTextures) {
      this.target.setSize(sizePx.x, sizePx.y);
      renderer.setRenderTarget(this.target);
      renderer.clear();
      renderer.render(this.scene, camera);
      return;
    }
    if (!this.isEmpty || this.target.width > 1) this.emptyTextures(renderer);
    const { dome, uniforms } = this.sky;
    // Over a horizon the sky comes after the water, in the pixels that remain.
    dome.visible = !this.isOpenSea;
    uniforms["u_is_displayed"]!.value = true;
    renderer.setRenderTarget(null);
    renderer.render(this.scene, camera);
    uniforms["u_is_displayed"]!.value = false;
    dome.visible = true;
  }

  /** Passes that compare with the textures' depth find nothing in front. */
  private emptyTextures(renderer: WebGLRenderer): void {
    this.target.setSize(1, 1);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    this.isEmpty = true;
  }

  /** Draws the sky of an open sea where the canvas shows nothing yet. Call it where the solids are on it. */
  drawSky({ renderer, camera }: Picture): void {
    if (!this.isOpenSea) return;
    const { dome, uniforms } = this.sky;
    uniforms["u_is_displayed"]!.value = true;
    renderer.setRenderTarget(null);
    renderer.render(dome, camera);
    uniforms["u_is_displayed"]!.value = false;
  }

  dispose(): void {
    this.boats?.dispose();
    this.buoys?.dispose();
    this.floaters?.dispose();
    this.course?.dispose();
    this.gauges.dispose();
    this.surroundings.dispose();
    for (const material of this.materials) material.dispose();
    this.target.dispose();
  }
}
