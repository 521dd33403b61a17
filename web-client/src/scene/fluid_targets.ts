// Render targets of the fluid's passes.
import { FloatType, HalfFloatType, LinearFilter, NearestFilter, RGBAFormat, RGFormat, WebGLRenderTarget } from "three";

/** 1 / distance and foam. Full floats: normals come from differences of neighbours. */
export function makeFrontTarget(depthBuffer: boolean): WebGLRenderTarget {
  return new WebGLRenderTarget(1, 1, { format: RGFormat, type: FloatType, minFilter: NearestFilter, magFilter: NearestFilter, depthBuffer });
}

/** Four half floats, filtered and blendable. */
export function makeHalfTarget(): WebGLRenderTarget {
  return new WebGLRenderTarget(1, 1, { format: RGBAFormat, type: HalfFloatType, minFilter: LinearFilter, magFilter: LinearFilter, depthBuffer: false });
}
