// Counts the WebGL objects of a page that were made and not deleted, by kind.

/** Runs in the page before its own code. `window.glObjects()` returns the counts. */
export function countGlObjects() {
  const kinds = ["Buffer", "Framebuffer", "Program", "Renderbuffer", "Shader", "Texture", "VertexArray"];
  const counts = Object.fromEntries(kinds.map((kind) => [kind, 0]));
  const methods = WebGL2RenderingContext.prototype;
  for (const kind of kinds) {
    const [make, remove] = [methods[`create${kind}`], methods[`delete${kind}`]];
    const alive = new WeakSet();
    methods[`create${kind}`] = function (...given) {
      const made = make.apply(this, given);
      if (made) {
        alive.add(made);
        ++counts[kind];
      }
      return made;
    };
    methods[`delete${kind}`] = function (removed) {
      if (removed && alive.delete(removed)) --counts[kind];
      return remove.call(this, removed);
    };
  }
  window.glObjects = () => ({ ...counts });
}
