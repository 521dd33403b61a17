// What is drawn when the camera is in the water or close over it: the surface from below, and the solids seen through water. Each pixel
// decides by itself whether its way begins in the water, so that the surface divides the picture where the camera is half below it.
import { BackSide, Matrix4, Vector3, type PerspectiveCamera, type RawShaderMaterial, type Vector2 } from "three";

import type { SurfaceFrame } from "../../net/messages";
import { elevationAtM } from "../frames/height_field";
import { depthAtM, type Bed } from "../landscape/terrain";
import { makeMaterial, type Uniforms } from "../shaders/materials";

/** The surface may divide the picture where the camera is over the water by less than this many near planes: the lower edge of the near
 * plane is half of one below the camera, and the water may rise by one toward it. */
const kCloseNears = 2;
/** Shallower water is a film on dry ground, m. */
const kDryM = 0.01;

export class BelowSurface {
  /** Of the water's meshes, seen from below. */
  readonly surface: RawShaderMaterial;
  /** Of a triangle over the canvas (sky_dome.vert). */
  readonly solids: RawShaderMaterial;
  private readonly uniforms: Uniforms;
  private readonly ahead = new Vector3();
  private readonly isPlain: boolean;

  /**
   * `floorAlbedo`: on average, where the floor is not on the screen. `isCut`: the water ends at panes of glass. `uniforms` and `defines` are
   * those of the water; `newest` returns the newest frame of the surface.
   */
  constructor(
    floorAlbedo: Vector3,
    private readonly isCut: boolean,
    uniforms: Uniforms,
    defines: Record<string, number>,
    private readonly newest: () => SurfaceFrame | undefined,
    private readonly bed: Bed,
  ) {
    this.isPlain = "PLAIN" in defines;
    this.uniforms = {
      ...uniforms,
      u_floor_albedo: { value: floorAlbedo },
      u_inverse_projection: { value: new Matrix4() },
      u_camera_world: { value: new Matrix4() },
      u_camera_ahead: { value: this.ahead },
    };
    this.surface = makeMaterial("waterBelow", this.uniforms, { side: BackSide, defines });
    this.solids = makeMaterial("presentBelow", this.uniforms, { depthWrite: false, defines });
  }

  /** Returns whether a picture from this camera shows the water from below. */
  isSeen(camera: PerspectiveCamera): boolean {
    const frame = this.newest();
    const { x, y, z } = camera.position;
    const extentM = this.uniforms["u_extent_m"]!.value as Vector2;
    const isBeside = this.isCut && Math.max(Math.abs(x) - extentM.x / 2, Math.abs(z) - extentM.y / 2) > camera.near;
    // The sides show the surface from below themselves (side.glsl).
    if (isBeside && !this.isPlain) return false;
    const elevationM = frame ? elevationAtM(frame, x, z) : 0;
    if (y > elevationM + (isBeside ? 0 : kCloseNears * camera.near)) return false;
    // Over dry ground the elevation is that of the ground.
    if (elevationM + depthAtM(this.bed, x, z) < kDryM) return false;
    (this.uniforms["u_inverse_projection"]!.value as Matrix4).copy(camera.projectionMatrixInverse);
    (this.uniforms["u_camera_world"]!.value as Matrix4).copy(camera.matrixWorld);
    camera.getWorldDirection(this.ahead);
    return true;
  }

  dispose(): void {
    this.surface.dispose();
    this.solids.dispose();
  }
}
