// Uses Vitest and the generated messages of the web client; the packages of package.json are installed here.
export default {
  define: { __PROGRAM_VERSION__: '"of the test"' },
  test: { include: ["*.test.mjs"], environment: "node", globals: true, testTimeout: 120_000, hookTimeout: 180_000 },
};
