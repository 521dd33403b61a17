// Falling rain: streaks in a box around the camera, as long as a drop falls in a short exposure, slanted by the wind. Reads the solids' depth and
// the canvas. Writes the canvas.
import { BufferAttribute, BufferGeometry, LineSegments, NormalBlending, Scene, Vector2, Vector3, type RawShaderMaterial } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { Pass, Picture } from "../drawing/pass";
import type { Sky } from "../light/sky";
import { rainShare } from "../light/weather";
import { makeFastRandom } from "../maths/random";
import { makeMaterial } from "../shaders/materials";
import type { SolidsPass } from "../solids/solids_pass";
import { makeDropSeeds } from "./drop_seeds";

/** Both ends of a streak. */
const kEnds = 2;
/** A drop of 2 mm falls at about this speed (Gunn and Kinzer 1949: 6.5 m/s), and takes over this share of the wind. */
const kFallMps = 6.5;
const kWindShare = 0.6;
const kSeed = 20_260_202;

export class RainStreaksPass implements Pass {
  readonly name = "rain streaks";
  readonly reads = ["solids", "canvas"] as const;
  readonly writes = ["canvas"] as const;
  private readonly scene = new Scene();
  private readonly lines: LineSegments<BufferGeometry, RawShaderMaterial>;

  /** `greeting` is read in every picture, because its wind changes. `streaksCount`: in the hardest rain. */
  constructor(
    private readonly greeting: GreetingInfo,
    solids: SolidsPass,
    sky: Sky,
    private readonly streaksCount: number,
  ) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(makeDropSeeds(streaksCount, kEnds, makeFastRandom(kSeed)), 4));
    const uniforms = {
      ...sky.uniforms,
      u_behind_depth: { value: solids.textures.depth },
      u_target_px: { value: new Vector2(1, 1) },
      u_camera_m: { value: new Vector3() },
      u_velocity_mps: { value: new Vector3() },
      u_time_s: { value: 0 },
    };
    this.lines = new LineSegments(geometry, makeMaterial("rainStreak", uniforms, { blending: NormalBlending, transparent: true, depthWrite: false }));
    this.lines.frustumCulled = false;
    this.scene.add(this.lines);
  }

  draw({ renderer, camera, sizePx, shownS }: Picture): void {
    const { wind } = this.greeting;
    const count = Math.round(rainShare(wind) * this.streaksCount);
    // Below the still water there is no rain in the air.
    if (!wind || shownS === undefined || count === 0 || camera.position.y < 0) return;
    const { uniforms } = this.lines.material;
    const angle = (wind.directionDeg * Math.PI) / 180;
    const blowsMps = kWindShare * wind.levelRatio * wind.speedMps;
    (uniforms["u_velocity_mps"]!.value as Vector3).set(blowsMps * Math.cos(angle), -kFallMps, blowsMps * Math.sin(angle));
    (uniforms["u_camera_m"]!.value as Vector3).copy(camera.position);
    (uniforms["u_target_px"]!.value as Vector2).copy(sizePx);
    uniforms["u_time_s"]!.value = shownS;
    this.lines.geometry.setDrawRange(0, count * kEnds);
    renderer.setRenderTarget(null);
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.lines.geometry.dispose();
    this.lines.material.dispose();
  }
}
