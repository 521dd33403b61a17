import { defineConfig } from "vite";

import { programVersion } from "../scripts/program_version.mjs";

/** Modules for programs: readable, and without the libraries that package.json names. */
export default defineConfig({
  root: import.meta.dirname,
  publicDir: false,
  define: { __PROGRAM_VERSION__: JSON.stringify(programVersion()) },
  build: {
    target: "es2022",
    minify: false,
    outDir: "dist",
    lib: { entry: { index: "index.ts", node: "node.ts", mcp: "mcp/main.ts" }, formats: ["es"] },
    rollupOptions: { external: [/^@bufbuild\/protobuf/, /^@modelcontextprotocol\//, /^node:/, "ws", "fast-png", "zod"], output: { entryFileNames: "[name].js", chunkFileNames: "[name].js" } },
  },
});
