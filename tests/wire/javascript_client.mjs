// The npm package spindrift-client, installed as a user would, with the real server and with one that a test writes. Importing this installs
// and starts them for the tests of a file; what a test opens ends after it.
import { rmSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { WebSocketServer } from "ws";

import { create, fromBinary, toBinary } from "../../web-client/node_modules/@bufbuild/protobuf";
import { Layer, ClientMessageSchema, ServerMessageSchema } from "../../web-client/client/gen/spindrift/v1/wire_pb";
import { startServer } from "../browser/server.mjs";
import { installClient } from "./installed_client.mjs";

export let folder;
export let client;
export let server;

beforeAll(async () => {
  folder = installClient();
  client = await import(pathToFileURL(join(folder, "node_modules/spindrift-client/node.js")).href);
  server = await startServer();
});
afterAll(async () => {
  await server?.stop("SIGTERM");
  if (folder) rmSync(folder, { recursive: true, force: true });
});

const ends = [];
afterEach(async () => {
  for (const end of ends.splice(0).reverse()) await end();
});

export async function connected(url = server.url, options = {}) {
  const water = await client.connect(url, options);
  ends.push(() => water.close());
  return water;
}

/** Starts another server. */
export async function started(port, options) {
  const other = await startServer(port, options);
  ends.push(() => other.stop("SIGTERM"));
  return other;
}

/** Resolves to what a promise was rejected with. */
export const failure = (promise) => promise.then((value) => expect.fail(`resolved to ${JSON.stringify(value)}`), (error) => error);

/** Reads frames of a layer until one is as wanted. */
export async function frameOf(water, layer, accept) {
  for (;;) {
    const frame = await water.next(layer);
    if (accept(frame)) return frame;
  }
}

export function bytesOf(message) {
  return toBinary(ServerMessageSchema, create(ServerMessageSchema, { message }));
}

/** Starts a server of the test: greets, welcomes, and then does `answer` for each message of the client. */
export async function fakeServer({ version = { major: 1, minor: client.kWireMinor }, answer = () => {} } = {}) {
  const layers = [Layer.SURFACE, Layer.PARTICLES, Layer.FOAM, Layer.BODIES, Layer.FLOATERS];
  const scene = { name: "fake", wave: { resolutionCount: 16, sideM: 8, depthM: 1 } };
  const sockets = new WebSocketServer({ port: 0, host: "127.0.0.1" });
  sockets.on("connection", (socket) => {
    socket.send(bytesOf({ case: "greeting", value: { version, room: "main", layers, scene } }));
    socket.on("message", (data) => {
      const { message } = fromBinary(ClientMessageSchema, data);
      if (message.case === "hello") socket.send(bytesOf({ case: "welcome", value: { personId: 7, resumeKey: "key" } }));
      answer(message, socket);
    });
  });
  await new Promise((resolve) => sockets.on("listening", resolve));
  ends.push(() => {
    for (const socket of sockets.clients) socket.terminate();
    return new Promise((resolve) => sockets.close(resolve));
  });
  return { url: `ws://127.0.0.1:${sockets.address().port}` };
}
