// Vitest and the generated messages are the web client's; only `ws` and `protobufjs` are installed here.
export default {
  test: { include: ["*.test.mjs"], environment: "node", globals: true, testTimeout: 120_000, hookTimeout: 180_000 },
};
