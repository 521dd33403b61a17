import { defineConfig } from "vitest/config";

const server = "http://127.0.0.1:8080";

export default defineConfig({
  // The server's Content-Security-Policy allows only files of its own: nothing is inlined as data or script.
  build: { target: "es2022", assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 900 },
  worker: { format: "es" },
  server: {
    host: "127.0.0.1",
    proxy: { "/ws": { target: server, ws: true }, "/api": server },
  },
  test: { include: ["test/**/*.test.ts"], environment: "node" },
});
