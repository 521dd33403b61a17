// The sky: baked once into a cube that the dome, the water's mirror and the particles' gloss all read.
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

export class Sky {
  /** Unit vector toward the sun. */
  readonly sunDirection = new Vector3(-0.42, 0.44, -0.79).normalize();
  /** What every material that mirrors the sky takes in. */
  readonly uniforms: Uniforms;
  readonly dome: Mesh;
  private readonly cube: WebGLCubeRenderTarget;
  private readonly domeUniforms: Uniforms;

  /** `smooth`: with mip levels, for still reflections far away; software renderers are better off without. */
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
    };
    this.dome = new Mesh(makeFullscreenGeometry(), makeMaterial("skyDome", this.domeUniforms, { depthWrite: false }));
    this.dome.frustumCulled = false;
    // After everything solid: only the pixels that are left.
    this.dome.renderOrder = 10;
  }

  /** Draws the cube; again after the WebGL context was lost and restored. */
  bake(renderer: WebGLRenderer): void {
    const material = makeMaterial("skyBake", { u_sun_direction: { value: this.sunDirection } }, { side: BackSide });
    const box = new Mesh(new BoxGeometry(2, 2, 2), material);
    const scene = new Scene();
    scene.add(box);
    new CubeCamera(0.1, 10, this.cube).update(renderer, scene);
    box.geometry.dispose();
    material.dispose();
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
