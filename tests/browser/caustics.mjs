// Draws the page's caustics shaders over known water and reads the light back.
import { readFileSync } from "node:fs";
import { join } from "node:path";

import { repository } from "./server.mjs";

const text = (name) => readFileSync(join(repository, "web-client/src/scene/shaders", name), "utf8").replace(/#include <(\w+)>/g, (_, part) => text(`${part}.glsl`));
const shader = (name) => "#version 300 es\nprecision highp float;\nprecision highp sampler2D;\n" + text(name);

/**
 * Draws waves that are flat at the sides of the square, and still water.
 * @returns {Promise<{mean: number, most: number, still_mean: number, still_most: number}>} light on the floor relative to level water
 */
export async function focusLight(page) {
  return page.evaluate(
    ([vertex, fragment]) => {
      const side_m = 16;
      const field_count = 128;
      const cells_count = 192;
      const texels_count = 256;
      const gl = new OffscreenCanvas(4, 4).getContext("webgl2");
      if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("no floating-point targets");
      gl.getExtension("OES_texture_float_linear");
      const program = gl.createProgram();
      for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const part = gl.createShader(kind);
        gl.shaderSource(part, text);
        gl.compileShader(part);
        if (!gl.getShaderParameter(part, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(part));
        gl.attachShader(program, part);
      }
      gl.bindAttribLocation(program, 0, "position");
      gl.linkProgram(program);
      gl.useProgram(program);

      // Triangles of the grid, without an index.
      const corners = [];
      const at = (n) => n / cells_count - 0.5;
      for (let k = 0; k < cells_count; ++k)
        for (let i = 0; i < cells_count; ++i)
          for (const [di, dk] of [[0, 0], [0, 1], [1, 0], [1, 0], [0, 1], [1, 1]]) corners.push(at(i + di), 1, at(k + dk));
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(corners), gl.STATIC_DRAW);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);

      const target = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, target);
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA16F, texels_count, texels_count);
      gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
      gl.viewport(0, 0, texels_count, texels_count);
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE);

      const uniform = (name) => gl.getUniformLocation(program, name);
      gl.uniform1i(uniform("u_field"), 0);
      gl.uniform3f(uniform("u_sun_direction"), -0.4255, 0.4457, -0.7876);
      gl.uniform2f(uniform("u_extent_m"), side_m, side_m);
      gl.uniform1f(uniform("u_deep_m"), 1.5);
      gl.uniform1f(uniform("u_reach"), 1.12);
      gl.uniform2f(uniform("u_layer"), 1, 0);
      gl.uniform1f(uniform("u_texel_m"), side_m / texels_count);

      const draw = (amplitude_m) => {
        const number = 2 * Math.PI / 2.5;
        // A wave of 2.5 m in two directions, times a window that is 0 with its slope at the sides.
        const elevation = (x, z) => {
          const window = (a) => (Math.abs(a) < 6 ? Math.cos((Math.PI * a) / 12) ** 4 : 0);
          return amplitude_m * window(x) * window(z) * (Math.sin(number * x) + Math.sin(number * (0.6 * x + 0.8 * z)));
        };
        const field = new Float32Array(field_count * field_count * 4);
        for (let k = 0; k < field_count; ++k)
          for (let i = 0; i < field_count; ++i) {
            const [x, z] = [((i + 0.5) / field_count - 0.5) * side_m, ((k + 0.5) / field_count - 0.5) * side_m];
            const d = 0.01;
            field.set([elevation(x, z), (elevation(x + d, z) - elevation(x - d, z)) / (2 * d), (elevation(x, z + d) - elevation(x, z - d)) / (2 * d), 0], 4 * (k * field_count + i));
          }
        gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, field_count, field_count, 0, gl.RGBA, gl.FLOAT, field);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
        gl.clearColor(0, 0, 0, 0);
        gl.clear(gl.COLOR_BUFFER_BIT);
        gl.drawArrays(gl.TRIANGLES, 0, corners.length / 3);
        const light = new Float32Array(texels_count * texels_count * 4);
        gl.readPixels(0, 0, texels_count, texels_count, gl.RGBA, gl.FLOAT, light);
        let sum = 0;
        let most = 0;
        for (let n = 0; n < light.length; n += 4) {
          sum += light[n];
          most = Math.max(most, light[n]);
        }
        return { mean: sum / (light.length / 4), most };
      };
      const waves = draw(0.06);
      const still = draw(0);
      return { ...waves, still_mean: still.mean, still_most: still.most };
    },
    [shader("caustics.vert"), shader("caustics.frag")],
  );
}
