import { defineConfig } from "vite";

/** One module under a fixed name: pages of others load it from there. */
export default defineConfig({
  root: import.meta.dirname,
  publicDir: false,
  build: { target: "es2022", outDir: "dist", lib: { entry: "element.ts", formats: ["es"], fileName: () => "element.js" } },
});
