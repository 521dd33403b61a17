import { readFileSync } from "node:fs";

import { defineConfig } from "vitest/config";

const server = "http://127.0.0.1:8080";

/** The version of the program; CMakeLists.txt is the only file that holds it. */
function programVersion(): string {
  const text = readFileSync(new URL("../CMakeLists.txt", import.meta.url), "utf8");
  const version = /^project\(spindrift VERSION ([0-9.]+)/m.exec(text)?.[1];
  if (version === undefined) throw new Error("CMakeLists.txt: project(spindrift VERSION ...) not found");
  return version;
}

export default defineConfig({
  define: { __PROGRAM_VERSION__: JSON.stringify(programVersion()) },
  // Behind a proxy the page may be at any path.
  base: "./",
  // The server's Content-Security-Policy allows only files of its own: nothing is inlined as data or script.
  build: { target: "es2022", assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 900 },
  worker: { format: "es" },
  server: {
    host: "127.0.0.1",
    proxy: { "/ws": { target: server, ws: true }, "/api": server },
  },
  test: { include: ["test/**/*.test.ts"], environment: "node" },
});
