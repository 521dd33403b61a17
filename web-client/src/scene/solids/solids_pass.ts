// Everything but water: the sky, what is around the water, boats, buoys, gauges and objects. Reads the field, for buoys, the shore, the caustics, the shadow, and the
// frames of boats and objects.
// Writes the solids' colour (linear light) and depth.
import { DepthTexture, Scene, UnsignedIntType, Vector2, Vector3, WebGLRenderTarget, type RawShaderMaterial, type Texture } from "three";

import type { GameInfo } from "../../../client/codec/game";
import type { BoatDetail, GreetingInfo } from "../../../client/codec/greeting";
import type { GaugeInfo } from "../../../client/codec/scene_info";
import { Boats } from "../boats/boats";
import { buoyPlaces, Buoys } from "../boats/buoys";
import { CourseMarks } from "../boats/course_marks";
import type { BoatColors } from "../boats/livery";
import type { Pass, Picture } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import { Floaters } from "../floaters/floaters";
import type { BodyPose } from "../../../client/codec/bodies";
import type { FloaterPose } from "../../../client/codec/floaters";
import type { StreamedFrames } from "../frames/streamed_frames";
import { bedOf } from "../landscape/terrain";
import type { Lamps } from "../light/lamps";
import type { Sky } from "../light/sky";
import { hazeM } from "../light/weather";
import { clamp } from "../maths/interpolate";
import type { OpenSea } from "../sea/open_sea";
import { makeMaterial, type Uniforms } from "../shaders/materials";
import { GaugePoles, type Pole } from "./gauge_poles";
import { isIndoors, Surroundings } from "./surroundings";

/** Size of the grain on stone and sand: a share of the side within bounds. */
const kGrainSides = 1 / 16;
const kGrainLimitsM = [0.5, 4] as const;
/** Stone is wet up to this share of the depth above the still water. */
const kWetDepths = 0.08;

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
  /** Uniforms of caustics.glsl, shadow.glsl and shore.glsl; undefined where the scene does not have them. */
  readonly sunlight: LitBy;
  private readonly material: RawShaderMaterial;
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
  ) {
    const { sideM, widthM } = greeting;
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
    const defines: Record<string, number> = { ...(quality.plain && { PLAIN: 1 }), ...(isIndoors(greeting) && { TANK: 1 }), ...(caustics && { CAUSTICS: 1 }), ...(shadow && { SHADOWS: 1 }), ...(shore && { SHORE: 1 }) };
    this.material = makeMaterial("solid", uniforms, { defines });
    this.surroundings = new Surroundings(greeting, { sky, noise, field, caustics, shadow, sea, haze: this.haze, solid: this.material, quality });
    this.gauges = new GaugePoles(greeting, this.material);
    this.scene.add(sky.dome, ...this.surroundings.solids, this.gauges.mesh);
    if (greeting.hasBoats) {
      this.boats = new Boats(this.scene, this.material, makeMaterial("solid", uniforms, { defines, colorWrite: false }), quality.plain);
      this.boats.setBoats(greeting.boats);
    }
    if (greeting.hasFloaters) this.floaters = new Floaters(this.scene, makeMaterial("solid", uniforms, { defines: { ...defines, INSTANCES: 1 } }), greeting, quality.plain);
    const buoys = field ? buoyPlaces(greeting) : [];
    if (buoys.length > 0) {
      this.buoys = new Buoys(buoys, makeMaterial("solid", uniforms, { defines: { ...defines, FLOATS: 1 } }), quality.plain);
      this.scene.add(this.buoys.group);
    }
    if (field && greeting.course) {
      this.course = new CourseMarks(greeting.course, makeMaterial("solid", uniforms, { defines: { ...defines, FLOATS: 1 } }), quality.plain);
      this.scene.add(this.course.group);
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

  draw({ renderer, camera, sizePx, shownS }: Picture): void {
    this.place(shownS);
    this.target.setSize(sizePx.x, sizePx.y);
    this.haze.value = isIndoors(this.greeting) ? 0 : hazeM(this.greeting);
    this.sky.follow(camera);
    this.surroundings.look(camera.position);
    (this.material.uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.boats?.dispose();
    this.buoys?.dispose();
    this.floaters?.dispose();
    this.course?.dispose();
    this.gauges.dispose();
    this.surroundings.dispose();
    this.material.dispose();
    this.target.dispose();
  }
}
