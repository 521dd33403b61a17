// Makes the WebGL renderer, and finds out what is below it: a GPU or a software renderer.
import { FloatType, HalfFloatType, WebGLRenderer } from "three";

import { isSoftware, type TexelType } from "./quality";

export interface MadeRenderer {
  renderer: WebGLRenderer;
  isSoftwareRenderer: boolean;
  texelType: TexelType;
}

/** Returns undefined where the browser has no WebGL 2 with floating-point targets. */
export function makeRenderer(canvas: HTMLCanvasElement): MadeRenderer | undefined {
  // Antialiasing is fixed when a context is made and depends on the renderer's name, which a temporary context returns.
  const scratch = document.createElement("canvas").getContext("webgl2");
  if (!scratch?.getExtension("EXT_color_buffer_float")) return undefined;
  const unmasked = scratch.getExtension("WEBGL_debug_renderer_info");
  const name = String(scratch.getParameter(unmasked ? unmasked.UNMASKED_RENDERER_WEBGL : scratch.RENDERER));
  scratch.getExtension("WEBGL_lose_context")?.loseContext();
  const isSoftwareRenderer = isSoftware(name);
  try {
    const renderer = new WebGLRenderer({ canvas, antialias: !isSoftwareRenderer, powerPreference: "high-performance" });
    // Targets are cleared to zero in all channels.
    renderer.setClearColor(0x000000, 0);
    // SwiftShader converts every half float that it samples: the water of the harbor took 45 instead of 34 ms.
    const texelType = isSoftwareRenderer && renderer.extensions.has("OES_texture_float_linear") ? FloatType : HalfFloatType;
    return { renderer, isSoftwareRenderer, texelType };
  } catch {
    // three has logged the reason.
    return undefined;
  }
}
