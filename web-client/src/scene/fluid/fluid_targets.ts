// Render targets of the fluid's passes.
import { AddEquation, CustomBlending, FloatType, HalfFloatType, NearestFilter, OneFactor, OneMinusDstAlphaFactor, RGFormat, WebGLRenderTarget, type ShaderMaterialParameters } from "three";

/** 1 / distance and foam. Full floats: normals come from differences of neighbours. */
export function makeFrontTarget(depthBuffer: boolean): WebGLRenderTarget {
  return new WebGLRenderTarget(1, 1, { format: RGFormat, type: FloatType, minFilter: NearestFilter, magFilter: NearestFilter, depthBuffer });
}

/** Four half floats, filtered and blendable. */
export function makeHalfTarget(): WebGLRenderTarget {
  return new WebGLRenderTarget(1, 1, { type: HalfFloatType, depthBuffer: false });
}

/** Blending of fluid_thickness.frag. */
export const thicknessBlending: ShaderMaterialParameters = {
  blending: CustomBlending,
  blendEquation: AddEquation,
  blendSrc: OneFactor,
  blendDst: OneFactor,
  blendSrcAlpha: OneMinusDstAlphaFactor,
  blendDstAlpha: OneFactor,
  depthTest: false,
  depthWrite: false,
  transparent: true,
};
