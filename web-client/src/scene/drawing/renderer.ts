// Makes the WebGL renderer, and finds out what is below it: a GPU or a software renderer.
import { FloatType, HalfFloatType, WebGLRenderer } from "three";

import { isSoftware, type TexelType } from "./quality";

export interface MadeRenderer {
  renderer: WebGLRenderer;
  isSoftwareRenderer: boolean;
  texelType: TexelType;
}

/** Returns undefined where the browser has no WebGL 2 with floating-point targets. May put a copy of `canvas`, which must have no listeners yet, in its position. */
export function makeRenderer(canvas: HTMLCanvasElement): MadeRenderer | undefined {
  // Antialiasing is fixed when a context is made, and depends on what is below it. A software renderer, where a context takes long, keeps the first one.
  const attributes: WebGLContextAttributes = { alpha: true, antialias: false, powerPreference: "high-performance" };
  let context: WebGL2RenderingContext | null = canvas.getContext("webgl2", attributes);
  if (!context?.getExtension("EXT_color_buffer_float")) return undefined;
  const unmasked = context.getExtension("WEBGL_debug_renderer_info");
  const name = String(context.getParameter(unmasked ? unmasked.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  const isSoftwareRenderer = isSoftware(name);
  if (!isSoftwareRenderer) {
    const copy = canvas.cloneNode() as HTMLCanvasElement;
    canvas.replaceWith(copy);
    context.getExtension("WEBGL_lose_context")?.loseContext();
    canvas = copy;
    context = canvas.getContext("webgl2", { ...attributes, antialias: true });
    if (!context) return undefined;
  }
  try {
    const renderer = new WebGLRenderer({ canvas, context });
    // Asking a program for errors waits until it is linked, which browsers do beside the page. They report a program that does not run by themselves.
    renderer.debug.checkShaderErrors = import.meta.env.DEV;
    // Targets are cleared to zero in all channels.
    renderer.setClearColor(0x000000, 0);
    // SwiftShader converts every half float that it samples: the water of the harbor took 45 instead of 34 ms.
    const texelType = isSoftwareRenderer && ["OES_texture_float_linear", "EXT_float_blend"].every((name) => renderer.extensions.has(name)) ? FloatType : HalfFloatType;
    return { renderer, isSoftwareRenderer, texelType };
  } catch {
    // three has logged the reason.
    return undefined;
  }
}
