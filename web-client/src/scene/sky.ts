// The sky, or a room: baked once into a cube map that the dome, the water's reflection and the particles' gloss read.
import {
  BackSide,
  BoxGeometry,
  CubeCamera,
  HalfFloatType,
  LinearFilter,
  LinearMipmapLinearFilter,
  Matrix4,
  Mesh,
  Scene,
  Vector3,
  WebGLCubeRenderTarget,
  type PerspectiveCamera,
  type WebGLRenderer,
} from "three";

import { makeFullscreenGeometry } from "./fullscreen";
import { makeMaterial, type Uniforms } from "./shaders";

const kFaceCount = 512;
/** Height of the lowest direction in which the sky is seen over a horizon of land or sea. */
const kLowestShown = -0.03;

export class Sky {
  /** Unit vector toward the sun. */
  readonly sunDirection = new Vector3(-0.42, 0.44, -0.79).normalize();
  /** For every material that reflects the sky. */
  readonly uniforms: Uniforms;
  readonly dome: Mesh;
  private readonly cube: WebGLCubeRenderTarget;
  private readonly domeUniforms: Uniforms;

  /** `smooth`: with mip levels, against flicker in distant reflections; too slow for software renderers. */
  constructor(smooth: boolean) {
    this.cube = new WebGLCubeRenderTarget(smooth ? kFaceCount : kFaceCount / 2, {
      type: HalfFloatType,
      generateMipmaps: smooth,
      minFilter: smooth ? LinearMipmapLinearFilter : LinearFilter,
      magFilter: LinearFilter,
    });
    this.uniforms = { u_sky: { value: this.cube.texture }, u_sun_direction: { value: this.sunDirection } };
    this.domeUniforms = {
      ...this.uniforms,
      u_inverse_projection: { value: new Matrix4() },
      u_camera_world: { value: new Matrix4() },
      u_has_sun: { value: true },
      u_lowest: { value: -1 },
    };
    this.dome = new Mesh(makeFullscreenGeometry(), makeMaterial("skyDome", this.domeUniforms, { depthWrite: false }));
    this.dome.frustumCulled = false;
    // After the solids: only the remaining pixels are shaded.
    this.dome.renderOrder = 10;
  }

  /** Draws the cube map of the open sky or of a room; needed again after the WebGL context was restored. */
  bake(renderer: WebGLRenderer, indoors: boolean): void {
    (this.domeUniforms["u_has_sun"]!).value = !indoors;
    const material = makeMaterial(indoors ? "roomBake" : "skyBake", { u_sun_direction: { value: this.sunDirection } }, { side: BackSide });
    const box = new Mesh(new BoxGeometry(2, 2, 2), material);
    const scene = new Scene();
    scene.add(box);
    new CubeCamera(0.1, 10, this.cube).update(renderer, scene);
    box.geometry.dispose();
    material.dispose();
  }

  /** `hasHorizon`: something hides the lower half of the dome, so that it need not be shaded. */
  hideBelowHorizon(hasHorizon: boolean): void {
    this.domeUniforms["u_lowest"]!.value = hasHorizon ? kLowestShown : -1;
  }

  follow(camera: PerspectiveCamera): void {
    (this.domeUniforms["u_inverse_projection"]!.value as Matrix4).copy(camera.projectionMatrixInverse);
    (this.domeUniforms["u_camera_world"]!.value as Matrix4).copy(camera.matrixWorld);
  }

  dispose(): void {
    this.cube.dispose();
    this.dome.geometry.dispose();
    (this.dome.material as { dispose(): void }).dispose();
  }
}
