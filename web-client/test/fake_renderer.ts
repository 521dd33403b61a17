// A renderer that takes every call and draws nothing.
import { WebGLCoordinateSystem, type WebGLRenderer } from "three";

/** `values`: what is read of it, and calls that do something. */
export function fakeRenderer(values: Record<string, unknown> = {}): WebGLRenderer {
  const all: Record<string, unknown> = {
    xr: { enabled: false },
    coordinateSystem: WebGLCoordinateSystem,
    autoClear: true,
    properties: { get: () => ({ currentProgram: { getUniforms: () => null } }) },
    ...values,
  };
  return new Proxy(all, {
    get: (target, key: string) => (key in target ? target[key] : () => null),
    set: (target, key: string, value) => ((target[key] = value), true),
  }) as unknown as WebGLRenderer;
}
