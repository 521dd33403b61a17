// Recordings that other programs open, read by @mcap/core: what is in them, their bounds, and how they end.
import { spawn } from "node:child_process";
import { existsSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress } from "fzstd";
import protobuf from "protobufjs";
import descriptor from "protobufjs/ext/descriptor.js";

import { fromBinary } from "../../web-client/node_modules/@bufbuild/protobuf";
import { FrameUnpacker } from "../../web-client/client/codec/frame_unpacker";
import { parse } from "../../web-client/client/codec/parse";
import { Layer, Packing, ServerMessageSchema } from "../../web-client/client/gen/spindrift/v1/wire_pb";
import { binary, command, post, repository, startServer, temporaryFolder, until } from "../browser/server.mjs";
import { Client } from "./client.mjs";

const kMiB = 1 << 20;
const kScene = ["--scene", `${repository}/tests/browser/scene.textproto`];
/** A scene with every layer. */
const kAllLayers = `
  name: "all_layers"
  wave { resolution_count: 96 side_m: 16 depth_m: 1.5 damping_per_s: 0.2 }
  particles { count: 1024 layers_count: 2 boundary_x: BOUNDARY_WALL boundary_z: BOUNDARY_WALL }
  coupling {}
  foam { surface: true }
  boats { capacity_count: 4 }
  floaters { capacity_count: 8 }
  stream { frame_rate_hz: 20 }`;
const kSplash = { splash: { depth_m: 0.4, radius_m: 2 } };
const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };

const folder = temporaryFolder("recording");
afterAll(() => rmSync(folder, { recursive: true }));

/** Asks for the recordings of a room; returns status and answer. */
async function ask(port, method, body, room = "main") {
  const options = { method, headers: { "Content-Type": "application/json" }, body: body && JSON.stringify(body) };
  if (!body) options.headers = {};
  const answer = await fetch(`http://127.0.0.1:${port}/api/v1/rooms/${room}/recording`, options);
  return { status: answer.status, body: await answer.json() };
}

/** Reads a finished file by its index; fails where a checksum of the summary is wrong. */
async function readIndexed(file) {
  const bytes = new Uint8Array(readFileSync(file));
  const readable = { size: async () => BigInt(bytes.length), read: async (at, size) => bytes.slice(Number(at), Number(at + size)) };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const messages = [];
  for await (const message of reader.readMessages()) messages.push({ topic: reader.channelsById.get(message.channelId).topic, ...message });
  const metadata = [];
  for await (const record of reader.readMetadata()) metadata.push(record);
  return { reader, messages, metadata };
}

/** Reads a file from its begin, with the checksums of its chunks; the end may be missing. */
function readStream(file) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(new Uint8Array(readFileSync(file)));
  const records = [];
  for (let record; (record = reader.nextRecord()); ) records.push(record);
  return { records, leftBytes: reader.bytesRemaining(), isWhole: reader.done() };
}

/** Bytes of the frames that a client receives, by layer, tick and whether they are deltas. */
function keyOf(bytes) {
  const { message } = fromBinary(ServerMessageSchema, bytes);
  if (message.case === "diagnostics") return `${Layer.DIAGNOSTICS} ${message.value.tick}`;
  return message.case === "frame" ? `${message.value.layer} ${message.value.tick} ${message.value.keyframe}` : undefined;
}

describe("a recording by a request", () => {
  let server;
  beforeAll(async () => {
    writeFileSync(join(folder, "all_layers.textproto"), kAllLayers);
    server = await startServer(0, ["--scene", join(folder, "all_layers.textproto"), "--room", `marina=${repository}/tests/browser/marina.textproto`, "--recordings", join(folder, "server")]);
  });
  afterAll(() => server?.stop("SIGTERM"));
  const pathOf = (name) => join(folder, "server", name);

  it("has the bytes that a client receives, and describes itself", async () => {
    const client = new Client(server.port);
    const received = new Map();
    client.ws.on("message", (data) => {
      const key = keyOf(new Uint8Array(data));
      if (key) received.set(key, Buffer.from(data));
    });
    await client.nextOf("greeting");
    client.send({ case: "hello", value: { version: { major: 1, minor: 11 }, client: "ws" } }); // older ones get plain floaters
    for (const layer of [Layer.SURFACE, Layer.PARTICLES, Layer.BODIES, Layer.FOAM, Layer.DIAGNOSTICS, Layer.FLOATERS]) client.subscribe(layer, Packing.PACKED);
    await client.nextOf("packedSurface");
    const { status, body } = await ask(server.port, "POST", { name: "run" });
    expect(status, JSON.stringify(body)).toBe(201);
    expect(body.recordings[0]).toMatchObject({ name: "run", room: "main", running: true, files: ["run_0001.mcap"] });
    client.command(1n, { case: "splash", value: { depthM: 0.3 } });
    client.command(2n, { case: "spawnBoat", value: { boat: { xM: 2, zM: 2 } } });
    client.command(3n, { case: "spawnFloater", value: { floater: { xM: -2, zM: -2 } } });
    await new Promise((resolve) => setTimeout(resolve, 3000));
    const ended = await ask(server.port, "DELETE");
    expect(ended.body.recordings[0]).toMatchObject({ running: false, failed: false, ended: "it was stopped", dropped_count: "0", skipped_count: "0" });
    expect((await client.close()).code).toBe(1000);

    const { reader, messages, metadata } = await readIndexed(pathOf("run_0001.mcap"));
    expect(String(messages.length)).toBe(ended.body.recordings[0].message_count);
    expect(String(statSync(pathOf("run_0001.mcap")).size)).toBe(ended.body.recordings[0].written_bytes);
    expect(reader.statistics.messageCount).toBe(BigInt(messages.length));
    expect(reader.chunkIndexes.length).toBeGreaterThan(1);
    expect(metadata[0].name).toBe("spindrift");
    expect(Object.fromEntries(metadata[0].metadata)).toMatchObject({ room: "main", wire: expect.stringMatching(/^1\./), server: expect.stringContaining("spindrift") });
    expect(messages[0].topic).toBe("/spindrift/greeting");
    const counts = {};
    for (const { topic, data } of messages) {
      const key = keyOf(data);
      if (!key || !received.has(key)) continue;
      expect(received.get(key).equals(Buffer.from(data)), `${topic}, ${key}`).toBe(true);
      counts[topic] = (counts[topic] ?? 0) + 1;
    }
    for (const topic of ["surface", "particles", "bodies", "foam", "floaters", "diagnostics"]) expect(counts[`/spindrift/${topic}`], topic).toBeGreaterThan(2);

    // A reader without the proto files.
    const [schema] = reader.schemasById.values();
    expect(schema).toMatchObject({ name: "spindrift.v1.ServerMessage", encoding: "protobuf" });
    const root = protobuf.Root.fromDescriptor(descriptor.FileDescriptorSet.decode(schema.data));
    const frame = messages.find(({ topic }) => topic === "/spindrift/surface");
    const decoded = root.lookupType(schema.name).decode(frame.data).frame;
    expect(decoded.keyframe).toBe(true);
    expect(Number(frame.publishTime)).toBeCloseTo(1e9 * decoded.time_s, -3);
    const nowNs = BigInt(Date.now()) * 1_000_000n;
    expect(frame.logTime > nowNs - 120_000_000_000n && frame.logTime <= nowNs).toBe(true);
  });

  it("begins new files that can each be read alone", async () => {
    await ask(server.port, "POST", { name: "parts", file_max_bytes: kMiB, max_bytes: 100 * kMiB, layers: ["LAYER_SURFACE", "LAYER_FOAM", "LAYER_PARTICLES"] });
    const three = await until("three files", async () => {
      await command(server, kSplash);
      const { body } = await ask(server.port, "GET");
      return body.recordings.at(-1).files.length >= 3;
    });
    expect(three).toBe(true);
    const { body } = await ask(server.port, "DELETE");
    expect(body.recordings.at(-1)).toMatchObject({ failed: false, skipped_count: "0" });
    const ticks = [];
    for (const file of body.recordings.at(-1).files) {
      expect(statSync(pathOf(file)).size).toBeLessThanOrEqual(kMiB);
      const { messages } = await readIndexed(pathOf(file));
      expect(messages[0].topic).toBe("/spindrift/greeting");
      const unpacker = new FrameUnpacker();
      for (const { topic, data } of messages) {
        if (topic === "/spindrift/greeting" || topic === "/spindrift/state") continue;
        const frame = unpacker.unpack(parse(data));
        if (topic === "/spindrift/surface") ticks.push(frame.header.tick);
      }
    }
    expect(ticks.length).toBeGreaterThan(10);
    for (let k = 1; k < ticks.length; ++k) expect(ticks[k] > ticks[k - 1]).toBe(true);
  });

  it("refuses what it may not do, with the reason", async () => {
    for (const name of ["", "../x", "a/b", ".hidden", "x".repeat(65)]) expect((await ask(server.port, "POST", { name })).status, name).toBe(422);
    expect(readdirSync(folder).sort()).toEqual(["all_layers.textproto", "server"]);
    const refusals = [
      [{ name: "run" }, 422, "run_0001.mcap exists already"],
      [{ name: "b", max_s: 1e9 }, 422, "max_s"],
      [{ name: "b", max_s: "NaN" }, 422, "max_s"],
      [{ name: "b", max_bytes: 1000 }, 422, "1000 bytes"],
      [{ name: "b", file_max_bytes: 5 }, 422, "files of at most 5 bytes"],
      [{ name: "b", max_bytes: "18446744073709551615" }, 409, "--recordings-max-mib"],
      [{ name: "b", layers: [77] }, 422, "77"],
      [{ name: "b", where: "/" }, 400, "where"],
    ];
    for (const [wanted, status, text] of refusals) {
      const answer = await ask(server.port, "POST", wanted);
      expect(answer.status, JSON.stringify(wanted)).toBe(status);
      expect(answer.body.message).toContain(text);
    }
    expect((await ask(server.port, "DELETE")).status).toBe(409);
    expect((await ask(server.port, "POST", { name: "one" })).status).toBe(201);
    expect(await ask(server.port, "POST", { name: "two" })).toMatchObject({ status: 409, body: { message: expect.stringContaining("'one'") } });
    expect((await ask(server.port, "DELETE")).status).toBe(200);
    expect(existsSync(pathOf("two_0001.mcap"))).toBe(false);
  });

  it("ends with its bounds, and with its room", async () => {
    await ask(server.port, "POST", { name: "short", max_s: 1 });
    await until("the end", async () => (await ask(server.port, "GET")).body.recordings.at(-1).ended.includes("bound of 1 s"));
    expect((await post(server, "api/v1/rooms", { name: "extra", scene: "splash" })).status).toBe(201);
    expect((await ask(server.port, "POST", { name: "extra" }, "extra")).status).toBe(201);
    await until("messages", () => statSync(pathOf("extra_0001.mcap")).size > 1000);
    expect((await fetch(`http://127.0.0.1:${server.port}/api/v1/rooms/extra`, { method: "DELETE" })).status).toBe(204);
    await until("the end of the file", async () => readStream(pathOf("extra_0001.mcap")).isWhole);
    expect((await readIndexed(pathOf("extra_0001.mcap"))).messages.length).toBeGreaterThan(0);
  });

  it("gets a new greeting with another scene", async () => {
    await ask(server.port, "POST", { name: "change" }, "marina");
    const answer = await command(server, { change_scene: { name: "splash" } }, { room: "marina" });
    expect(answer.status, await answer.text()).toBe(200);
    await new Promise((resolve) => setTimeout(resolve, 1500));
    await ask(server.port, "DELETE", undefined, "marina");
    const { messages, metadata } = await readIndexed(pathOf("change_0001.mcap"));
    const scenes = messages.filter(({ topic }) => topic === "/spindrift/greeting").map(({ data }) => fromBinary(ServerMessageSchema, data).message.value.scene.name);
    expect(scenes[0]).toBe("marina");
    expect(scenes.at(-1)).toBe("splash");
    expect(metadata.at(-1).metadata.get("scene")).toBe("splash");
  });

  it("is finished when the server ends", async () => {
    await ask(server.port, "POST", { name: "last" });
    await until("messages", () => statSync(pathOf("last_0001.mcap")).size > 1000);
    expect(await server.stop("SIGTERM")).toEqual({ code: 0, signal: null });
    expect((await readIndexed(pathOf("last_0001.mcap"))).messages.length).toBeGreaterThan(0);
  });
});

describe("a recording that cannot be finished", () => {
  it("can be read to its last chunk after kill -9", async () => {
    const server = await startServer(0, [...kScene, "--recordings", join(folder, "killed")]);
    await ask(server.port, "POST", { name: "run" });
    const file = join(folder, "killed", "run_0001.mcap");
    await until("three chunks", () => readStream(file).records.filter(({ type }) => type === "MessageIndex").length > 0 && statSync(file).size > 300_000);
    expect((await server.stop("SIGKILL")).signal).toBe("SIGKILL");
    const { records, leftBytes, isWhole } = readStream(file);
    expect(isWhole).toBe(false);
    expect(leftBytes).toBe(0);
    expect(records.filter(({ type }) => type === "Message").length).toBeGreaterThan(10);
    expect(records.some(({ type }) => type === "DataEnd")).toBe(false);
  });

  it("ends on a full disk, and the room runs on", async () => {
    const limit = ["-c", 'ulimit -f 1024; exec "$0" "$@"', binary, "serve", "--port", "0", ...kScene, "--recordings", join(folder, "full")];
    const child = spawn("bash", limit, { stdio: ["ignore", "pipe", "pipe"] });
    let log = "";
    child.stderr.setEncoding("utf8").on("data", (text) => (log += text));
    const exited = new Promise((resolve) => child.on("exit", (code) => resolve(code)));
    const port = await new Promise((resolve) => {
      createInterface({ input: child.stdout }).on("line", (line) => {
        const ready = /^Spindrift is ready: http:\/\/[^/]+:(\d+)\//.exec(line);
        if (ready) resolve(Number(ready[1]));
      });
    });
    await ask(port, "POST", { name: "run", plain: true });
    const failed = await until("the error", async () => (await ask(port, "GET")).body.recordings.find(({ running }) => !running));
    expect(failed).toMatchObject({ failed: true, ended: expect.stringContaining("ulimit -f") });
    const tick = async () => Number((await (await fetch(`http://127.0.0.1:${port}/api/v1/rooms/main`)).json()).tick);
    const before = await tick();
    const client = new Client(port);
    await client.nextOf("greeting");
    await until("further ticks", async () => (await tick()) > before + 10);
    await client.close();
    child.kill("SIGTERM");
    expect(await exited).toBe(0);
    expect(log).toContain("the recording run has ended: could not write");
    // The summary is there only if the disk has room for it.
    const { records, leftBytes } = readStream(join(folder, "full", "run_0001.mcap"));
    expect(leftBytes).toBe(0);
    expect(records.filter(({ type }) => type === "Message").length).toBeGreaterThan(0);
  });

  it("is refused by a server without a folder, and to players", async () => {
    const server = await startServer(0, kScene);
    expect(await ask(server.port, "POST", { name: "run" })).toMatchObject({ status: 409, body: { message: expect.stringContaining("--recordings") } });
    await server.stop("SIGTERM");
    const open = await startServer(0, [...kScene, "--guests", "player", "--recordings", join(folder, "open")]);
    for (const method of ["POST", "GET", "DELETE"]) expect((await ask(open.port, method, method === "POST" ? { name: "run" } : undefined)).status).toBe(403);
    await open.stop("SIGTERM");
  });
});

describe("spindrift record", () => {
  let server;
  beforeAll(async () => {
    server = await startServer(0, kScene);
  });
  afterAll(() => server?.stop("SIGTERM"));

  const record = (file, ...more) => {
    const child = spawn(binary, ["record", "--url", `ws://127.0.0.1:${server.port}`, "-o", join(folder, file), ...more], { stdio: ["ignore", "pipe", "pipe"] });
    const out = { text: "", error: "" };
    child.stdout.setEncoding("utf8").on("data", (text) => (out.text += text));
    child.stderr.setEncoding("utf8").on("data", (text) => (out.error += text));
    return { child, ended: new Promise((resolve) => child.on("close", (code) => resolve({ code, ...out }))) };
  };

  it("records a room with Foxglove's schemas, as an onlooker", async () => {
    const { ended } = record("client.mcap", "--for-s", "2", "--foxglove", "--json", "-");
    const { code, text, error } = await ended;
    expect(code, error).toBe(0);
    expect(JSON.parse(text)).toMatchObject({ files: ["client.mcap"], ended: expect.stringContaining("2 s"), malformed_count: 0, skipped_count: 0 });
    const { reader, messages } = await readIndexed(join(folder, "client.mcap"));
    const schemas = new Map([...reader.channelsById.values()].map(({ topic, schemaId }) => [topic, reader.schemasById.get(schemaId).name]));
    expect(schemas.get("/spindrift/surface")).toBe("spindrift.v1.ServerMessage");
    expect(schemas.get("/water/surface")).toBe("foxglove.Grid");
    expect(schemas.get("/water/particles")).toBe("foxglove.PointCloud");
    const own = messages.filter(({ topic }) => topic === "/spindrift/surface");
    const grids = messages.filter(({ topic }) => topic === "/water/surface");
    expect(own.length).toBeGreaterThan(5);
    expect(grids.length).toBe(own.length);
    const schema = [...reader.schemasById.values()].find(({ name }) => name === "foxglove.Grid");
    const grid = protobuf.Root.fromDescriptor(descriptor.FileDescriptorSet.decode(schema.data)).lookupType(schema.name).decode(grids[0].data);
    const frame = parse(own[0].data);
    expect(grid.column_count * (grid.data.length / grid.row_stride)).toBe(frame.payload.byteLength / 2);
  });

  it("begins new files, and ends with its signal", async () => {
    const { child, ended } = record("series.mcap", "--file-mib", "1", "--max-mib", "50", "--plain", "--layers", "surface,particles");
    await until("three files", () => existsSync(join(folder, "series_0003.mcap")));
    child.kill("SIGINT");
    const { code, text, error } = await ended;
    expect(code, error).toBe(0);
    expect(text).toContain("it was stopped");
    for (const number of [1, 2, 3]) expect((await readIndexed(join(folder, `series_000${number}.mcap`))).messages.length).toBeGreaterThan(2);
  });

  it("keeps packed layers decodable from file to file", async () => {
    const { child, ended } = record("packed.mcap", "--file-mib", "1", "--max-mib", "100", "--layers", "surface,foam,particles");
    await until("two files", async () => {
      await command(server, kSplash);
      return existsSync(join(folder, "packed_0002.mcap")) && statSync(join(folder, "packed_0002.mcap")).size > 100_000;
    });
    child.kill("SIGINT");
    expect((await ended).code).toBe(0);
    for (const number of [1, 2]) {
      const unpacker = new FrameUnpacker();
      const { messages } = await readIndexed(join(folder, `packed_000${number}.mcap`));
      for (const { topic, data } of messages) if (/surface|foam|particles/.test(topic)) unpacker.unpack(parse(data));
    }
  });

  it("refuses a file that exists, and says when there is no server", async () => {
    expect(await record("client.mcap").ended).toMatchObject({ code: 2, error: expect.stringContaining("exists already") });
    expect(await record("client.txt").ended).toMatchObject({ code: 2, error: expect.stringContaining(".mcap") });
    const { code, error } = await new Promise((resolve) => {
      const child = spawn(binary, ["record", "--url", "ws://127.0.0.1:1", "-o", join(folder, "none.mcap")], { stdio: ["ignore", "ignore", "pipe"] });
      let text = "";
      child.stderr.setEncoding("utf8").on("data", (more) => (text += more));
      child.on("close", (ended) => resolve({ code: ended, error: text }));
    });
    expect(code).toBe(2);
    expect(error).toContain("the server ended the connection");
    expect(existsSync(join(folder, "none.mcap"))).toBe(false);
  });
});
