// Makes the WebGL renderer with the quality that suits the GPU or software renderer below it.
import { WebGLRenderer } from "three";

import { chooseQuality, type ChosenQuality } from "./quality";

/** Returns undefined where the browser has no WebGL 2 with floating-point targets. */
export function makeRenderer(canvas: HTMLCanvasElement, search: string): { renderer: WebGLRenderer; quality: ChosenQuality } | undefined {
  // Antialiasing is fixed when a context is made and depends on the renderer's name, which a temporary context returns.
  const scratch = document.createElement("canvas").getContext("webgl2");
  if (!scratch?.getExtension("EXT_color_buffer_float")) return undefined;
  const unmasked = scratch.getExtension("WEBGL_debug_renderer_info");
  const name = String(scratch.getParameter(unmasked ? unmasked.UNMASKED_RENDERER_WEBGL : scratch.RENDERER));
  scratch.getExtension("WEBGL_lose_context")?.loseContext();
  const quality = chooseQuality(search, name);
  try {
    const antialias = quality.samplesCount > 1;
    const renderer = new WebGLRenderer({ canvas, antialias, powerPreference: "high-performance" });
    // Targets are cleared to zero in all channels.
    renderer.setClearColor(0x000000, 0);
    return { renderer, quality };
  } catch {
    // three has logged the reason.
    return undefined;
  }
}
