// Starts the translation of programs for the machine before they are needed. Drivers do it when a program is first drawn with; software
// renderers take 100 ms for each, in another process, and the page builds meshes meanwhile.
import { PerspectiveCamera, Scene, type BufferGeometry, type Material, type Mesh, type WebGLRenderer } from "three";

export type WarmUp = (meshes: readonly Mesh<BufferGeometry, Material>[]) => void;

/** Links the meshes' programs. In plain tiers, whose solids and water are on the canvas, it draws a triangle of each there: nothing may be shown yet. */
export function makeWarmUp(renderer: WebGLRenderer, plain: boolean): WarmUp {
  const camera = new PerspectiveCamera();
  return (meshes) => {
    const scene = new Scene().add(...meshes.map((mesh) => mesh.clone()));
    for (const mesh of scene.children) mesh.frustumCulled = false;
    renderer.compile(scene, camera);
    if (!plain) return;
    // All are linked before the first is drawn with: a question about a program waits for all that was drawn before.
    for (const { material } of meshes) (renderer.properties.get(material) as { currentProgram: { getUniforms(): void } }).currentProgram.getUniforms();
    const counts = meshes.map(({ geometry }) => geometry.drawRange.count);
    for (const { geometry } of meshes) geometry.setDrawRange(0, 3);
    renderer.setRenderTarget(null);
    renderer.render(scene, camera);
    meshes.forEach(({ geometry }, n) => geometry.setDrawRange(0, counts[n]!));
  };
}
