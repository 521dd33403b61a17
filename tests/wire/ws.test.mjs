// An independent WebSocket client with the real server: handshake, both packings, commands, closing.
import { startServer } from "../browser/server.mjs";
import { FrameUnpacker } from "../../web-client/client/codec/frame_unpacker";
import { Layer, Level, Packing } from "../../web-client/client/gen/spindrift/v1/wire_pb";
import { Client } from "./client.mjs";

let server;
beforeAll(async () => {
  server = await startServer();
});
afterAll(() => server?.stop("SIGTERM"));

const greeted = () => Client.greeted(server.port);

describe("the npm package ws", () => {
  it("negotiates the subprotocol and no extension, and receives the greeting first", async () => {
    const client = new Client(server.port);
    const first = await client.next(() => true);
    expect(first.kind).toBe("greeting");
    expect(client.ws.protocol).toBe("spindrift.v1");
    expect(client.ws.extensions).toBe("");
    expect((await client.close()).code).toBe(1000);
  });

  it("receives a status for a refused upgrade", async () => {
    const client = new Client(server.port, "/ws/no_such_room");
    const status = await new Promise((resolve) => client.ws.on("unexpected-response", (_, response) => resolve(response.statusCode)));
    expect(status).toBe(404);
    client.ws.terminate();
  });

  it("reads plain surfaces sample by sample", async () => {
    const client = await greeted();
    client.subscribe(Layer.SURFACE, Packing.PLAIN);
    let last_tick = -1n;
    let last_state = 0n;
    for (let i = 0; i < 5; ++i) {
      const { header, payload } = await client.nextOf("surface");
      expect(header.tick).toBeGreaterThan(last_tick);
      last_tick = header.tick;
      expect(header.stateId).toBeGreaterThan(last_state);
      last_state = header.stateId;
      expect(header.resolutionCount).toBe(144);
      expect(header.sideM).toBe(16);
      expect(payload.byteLength).toBe(2 * 144 * 144);
    }
    expect((await client.close()).code).toBe(1000);
  });

  it("receives the requested level of detail, with the server's time", async () => {
    const client = await greeted();
    client.subscribe(Layer.SURFACE, Packing.PLAIN, { level: Level.COARSE });
    const { header, payload } = await client.nextOf("surface");
    expect(header).toMatchObject({ resolutionCount: 128, level: "coarse", sideM: 16 });
    expect(payload.byteLength).toBe(2 * 128 * 128);
    const next = await client.nextOf("surface");
    const passedS = next.header.serverTimeS - header.serverTimeS;
    // One frame of twenty per second, even on a slow machine.
    expect(passedS).toBeGreaterThan(0.01);
    expect((await client.close()).code).toBe(1000);
  });

  it("reads packed surfaces with the same samples as the plain ones", async () => {
    const plain = await greeted();
    const packed = await greeted();
    plain.subscribe(Layer.SURFACE, Packing.PLAIN);
    packed.subscribe(Layer.SURFACE, Packing.PACKED);
    packed.command(1n, { case: "splash", value: { depthM: 0.3 } });
    const unpacker = new FrameUnpacker();
    const plain_by_tick = new Map();
    const packed_by_tick = new Map();
    const both = () => [...packed_by_tick.keys()].filter((tick) => plain_by_tick.has(tick));
    let continuing_count = 0;
    let first;
    while (both().length < 10) {
      const frame = await plain.nextOf("surface");
      plain_by_tick.set(frame.header.tick, Buffer.from(frame.payload));
      const coded = await packed.nextOf("packedSurface");
      first ??= coded;
      if (coded.baseTick !== undefined) ++continuing_count;
      const unpacked = unpacker.unpack(coded);
      expect(unpacked.kind).toBe("surface");
      packed_by_tick.set(unpacked.header.tick, Buffer.from(unpacked.payload));
    }
    expect(first.baseTick).toBeUndefined();
    expect(continuing_count).toBeGreaterThan(0);
    for (const tick of both()) expect(packed_by_tick.get(tick).equals(plain_by_tick.get(tick)), `tick ${tick}`).toBe(true);
    await Promise.all([plain.close(), packed.close()]);
  });

  it("sends a splash, receives its Ack, and the water moves", async () => {
    const client = await greeted();
    client.subscribe(Layer.SURFACE, Packing.PLAIN);
    client.command(42n, { case: "splash", value: { xM: 1, zM: -1, radiusM: 1.5, depthM: 0.5 } });
    const ack = await client.next((message) => message.kind === "ack" || message.kind === "reject");
    expect(ack).toMatchObject({ kind: "ack", commandId: 42n });
    const highest = ({ header, payload }) => {
      const samples = new Int16Array(payload.slice().buffer);
      return header.quantumM * samples.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
    };
    await client.next((message) => message.kind === "surface" && message.header.tick >= ack.appliedTick && highest(message) > 0.05);
    client.command(43n, { case: "splash", value: { depthM: 1000 } });
    expect(await client.nextOf("reject")).toMatchObject({ commandId: 43n, reason: "OUT_OF_RANGE" });
    await client.close();
  });

  it("may fragment a message, and receives pongs", async () => {
    const client = new Client(server.port);
    await client.nextOf("greeting");
    const hello = Client.bytesOf({ case: "hello", value: { version: { major: 1, minor: 0 }, client: "in pieces" } });
    const pong = new Promise((resolve) => client.ws.on("pong", (data) => resolve(String(data))));
    client.ws.send(hello.subarray(0, 1), { binary: true, fin: false });
    client.ws.ping("between");
    client.ws.send(hello.subarray(1, 2), { fin: false });
    client.ws.send(hello.subarray(2), { fin: true });
    expect(await pong).toBe("between");
    client.subscribe(Layer.SURFACE, Packing.PLAIN);
    await client.nextOf("surface");
    await client.close();
  });

  it("is closed with the documented code after each violation", async () => {
    const text = await greeted();
    text.ws.send("text");
    expect((await text.closed).code).toBe(1003);

    const big = await greeted();
    big.ws.send(new Uint8Array(big.messageMaxBytes() + 1));
    expect((await big.closed).code).toBe(1009);

    const odd = await greeted();
    odd.ws.send(new Uint8Array([0xff, 0xff]));
    expect((await odd.nextOf("refusal")).message).not.toBe("");
    expect((await odd.closed).code).toBe(1008);

    const future = await Client.greeted(server.port, { major: 2 });
    expect((await future.nextOf("refusal")).message).toContain("2.0");
    expect((await future.closed).code).toBe(1008);
  });

  it("receives 1001 when the server shuts down", async () => {
    const client = await greeted();
    client.subscribe(Layer.SURFACE, Packing.PACKED);
    await client.nextOf("packedSurface");
    const ended = server.stop("SIGTERM");
    expect((await client.closed).code).toBe(1001);
    expect(await ended).toEqual({ code: 0, signal: null });
  });
});
