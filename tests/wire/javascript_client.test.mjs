// The npm package spindrift-client, installed as a user would, with the real server and with one that this test writes.
import { execFile, spawnSync } from "node:child_process";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { promisify } from "node:util";
import { WebSocketServer } from "ws";

import { create, fromBinary, toBinary } from "../../web-client/node_modules/@bufbuild/protobuf";
import { Layer, ClientMessageSchema, ServerMessageSchema } from "../../web-client/client/gen/spindrift/v1/wire_pb";
import { freePort, repository, startServer } from "../browser/server.mjs";
import { installClient, kClientDist, npm } from "./installed_client.mjs";

const kGolden = join(repository, "tests/golden");
const run = promisify(execFile);

let folder;
let client;
let server;

beforeAll(async () => {
  folder = installClient();
  client = await import(pathToFileURL(join(folder, "node_modules/spindrift-client/node.js")).href);
  server = await startServer();
});
afterAll(async () => {
  await server?.stop("SIGTERM");
  if (folder) rmSync(folder, { recursive: true, force: true });
});

/** Clients of one test, closed after it. */
const opened = [];
afterEach(() => {
  for (const water of opened.splice(0)) water.close();
});
async function connected(url = server.url, options = {}) {
  const water = await client.connect(url, options);
  opened.push(water);
  return water;
}

/** Resolves to what a promise was rejected with. */
const failure = (promise) => promise.then((value) => expect.fail(`resolved to ${JSON.stringify(value)}`), (error) => error);

function bytesOf(message) {
  return toBinary(ServerMessageSchema, create(ServerMessageSchema, { message }));
}

/** A server of this test: greets, welcomes, and then does `answer` for each message of the client. */
async function fakeServer({ version = { major: 1, minor: client.kWireMinor }, answer = () => {} } = {}) {
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
  return {
    url: `ws://127.0.0.1:${sockets.address().port}`,
    stop() {
      for (const socket of sockets.clients) socket.terminate();
      return new Promise((resolve) => sockets.close(resolve));
    },
  };
}

describe("a project with the package", () => {
  it("has no other files than code, types, license and package.json, of the program's version", () => {
    const listed = JSON.parse(npm(folder, "pack", kClientDist, "--dry-run", "--json"))[0];
    const version = /^project\(spindrift VERSION (\d+\.\d+\.\d+) /m.exec(readFileSync(join(repository, "CMakeLists.txt"), "utf8"))[1];
    expect(listed.version).toBe(version);
    const others = listed.files.map(({ path }) => path).filter((path) => !/^(types\/.*\.d\.ts|\w+\.js|package\.json|LICENSE)$/.test(path));
    expect(others).toEqual([]);
  });

  const docs = readFileSync(join(repository, "docs/javascript.md"), "utf8");
  const examples = (text, language) => [...text.matchAll(new RegExp(`^\`\`\`${language}\\n(.*?)^\`\`\`$`, "gms"))].map(([, code]) => code);
  const atServer = (code) => code.replaceAll(/(127\.0\.0\.1|localhost):8080/g, `127.0.0.1:${server.port}`);

  it("runs every example of docs/javascript.md", async () => {
    const codes = examples(docs, "js");
    expect(codes.length).toBeGreaterThan(4);
    const outputs = [];
    for (const [k, code] of codes.entries()) {
      writeFileSync(join(folder, `example_${k}.mjs`), atServer(code));
      outputs.push((await run(process.execPath, [`example_${k}.mjs`], { cwd: folder, timeout: 60_000 })).stdout);
    }
    expect(outputs[0]).toMatch(/^144 x 144 heights, up to -?[\d.e-]+ m at [\d.]+ s\n$/);
    expect(outputs.join("")).toMatch(/OUT_OF_RANGE splash\.radius_m 1000 100 m 1000 m is above/);
  });

  it("compiles the example in TypeScript with both ways to resolve modules, and refuses a wrong field", () => {
    const [code, ...more] = examples(docs, "ts");
    expect(more).toEqual([]);
    const compile = (text, module, moduleResolution) => {
      writeFileSync(join(folder, "typed.ts"), text);
      const options = { module, moduleResolution, target: "es2022", lib: ["es2023", "dom"], strict: true, noEmit: true, types: [] };
      writeFileSync(join(folder, "tsconfig.json"), JSON.stringify({ compilerOptions: options, files: ["typed.ts"] }));
      return spawnSync(process.execPath, [join(repository, "web-client/node_modules/typescript/bin/tsc"), "-p", folder], { encoding: "utf8" }).stdout;
    };
    expect(compile(code, "nodenext", "nodenext")).toBe("");
    expect(compile(code, "esnext", "bundler")).toBe("");
    const wrong = code.replace("water.splash({ depthM })", 'water.splash({ depthM, radiusM: "wide" }).then(() => water.reset({ soon: true }))').replace("surface.heightsM", "surface.heights");
    const refused = compile(wrong, "nodenext", "nodenext");
    expect(refused).toMatch(/Type 'string' is not assignable to type 'number'/);
    expect(refused).toMatch(/'soon' does not exist/);
    expect(refused).toMatch(/'heights' does not exist/);
  });
});

describe("commands", () => {
  it("are resolved with the tick that shows them", async () => {
    const water = await connected();
    const before = await water.surface();
    const { appliedTick } = await water.splash({ xM: 1, depthM: 0.3 });
    expect(appliedTick).toBeGreaterThanOrEqual(before.tick);
    let surface;
    do surface = await water.surfaceAt(appliedTick + 1);
    while (Math.max(...surface.heightsM) < 0.02);
    expect(surface.heightsM).toHaveLength(surface.countX * surface.countZ);
  });

  it("are rejected with reason, field, value and bound", async () => {
    const water = await connected();
    const nan = await failure(water.splash({ xM: NaN }));
    expect(nan).toBeInstanceOf(client.Rejected);
    expect(nan).toBeInstanceOf(client.SpindriftError);
    expect(nan).toMatchObject({ name: "Rejected", reason: "NOT_FINITE", field: "splash.x_m", value: NaN, bound: { min: -500, max: 500, unit: "m" } });
    expect(await failure(water.splash({ radiusM: 1000 }))).toMatchObject({ reason: "OUT_OF_RANGE", field: "splash.radius_m", value: 1000, bound: { max: 100 } });
    expect(await failure(water.setParameter({ path: "no.such", value: 1 }))).toMatchObject({ reason: "UNKNOWN_PARAMETER", field: "no.such", bound: undefined });
    const { min, max } = water.parameters.get("wave.damping_per_s");
    const beyond = await failure(water.setParameter({ path: "wave.damping_per_s", value: max + 1 }));
    expect(beyond).toMatchObject({ reason: "OUT_OF_RANGE", field: "wave.damping_per_s", value: max + 1, bound: { min, max } });
    const point = { timeS: 0, xM: 0, zM: Infinity };
    expect(await failure(water.stroke({ strokeId: 1, points: [{ timeS: 0, xM: 0, zM: 0 }, point] }))).toMatchObject({ field: "stroke.points[1].z_m", value: Infinity, bound: { min: -500 } });
  });

  it("throw a TypeError for fields and types that they do not have, and send nothing", async () => {
    const water = await connected();
    expect(await failure(water.splash({ radius: 1 }))).toMatchObject({ name: "TypeError", message: expect.stringContaining("it has xM, zM, radiusM") });
    expect(await failure(water.spawnBoat({ boat: { xM: "east" } }))).toMatchObject({ name: "TypeError", message: expect.stringContaining("spawnBoat.boat.xM takes a number") });
    expect(await failure(water.stroke({ strokeId: 1.5 }))).toMatchObject({ name: "TypeError" });
    expect(await failure(water.command("sink", {}))).toMatchObject({ name: "TypeError", message: expect.stringContaining("splash") });
  });

  it("are rejected for a role that is too low", async () => {
    const other = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--guests", "viewer"]);
    try {
      const water = await connected(other.url);
      expect(water.role).toBe("viewer");
      expect(await failure(water.splash({}))).toMatchObject({ name: "Rejected", reason: "FORBIDDEN" });
      expect((await water.surface()).countX).toBe(144);
    } finally {
      await other.stop("SIGTERM");
    }
  });

  it("know parameters, people, boats and gauges of the room", async () => {
    const water = await connected(server.url, { room: "marina", name: "Ada" });
    const { boatId } = await water.spawnBoat({ boat: { xM: 2, zM: 2 } });
    let frame;
    do frame = await water.next("bodies");
    while (!frame.boat(boatId));
    expect(frame.ids).toContain(boatId);
    expect(frame.boat(boatId).xM).toBeCloseTo(2, 0);
    await water.controlBoat({ boatId, throttleRatio: 1 });
    do frame = await water.next("bodies");
    while (!(frame.boat(boatId).speedMps > 0.05));
    expect(water.boats.find((boat) => boat.boatId === boatId).lengthM).toBeGreaterThan(0);
    const own = () => water.people.find(({ personId }) => personId === water.personId);
    while (own()?.boatIds.length !== 1) await water.once("people");
    expect(own()).toMatchObject({ name: "Ada", boatIds: [boatId], role: water.role });
    const { gaugeId } = await water.placeGauge({ xM: 1, zM: 1 });
    let diagnostics;
    do diagnostics = await water.next("diagnostics");
    while (!diagnostics.gauges.some((gauge) => gauge.gaugeId === gaugeId && !gauge.unread));
    const series = await water.gauge(diagnostics.gauges.find((gauge) => gauge.gaugeId === gaugeId).name);
    expect(series.elevationM).toHaveLength(series.timeS.length);
    expect(series.timeS.length).toBeGreaterThan(0);
    expect(await failure(water.gauge("none"))).toBeInstanceOf(client.SpindriftError);
    await water.setParameter({ path: "wave.damping_per_s", value: 0.4 });
    if (water.parameters.get("wave.damping_per_s").value !== 0.4) await water.once("parameterChanged");
    expect(water.parameters.get("wave.damping_per_s").value).toBe(0.4);
  });

  it("wait at most 64 at a time, and are rejected when the client is closed", async () => {
    const fake = await fakeServer();
    const water = await connected(fake.url, { answerWithinS: 600 });
    const first = Array.from({ length: 64 }, () => failure(water.splash({})));
    expect(await failure(water.splash({}))).toMatchObject({ name: "SpindriftError", message: expect.stringContaining("64 commands") });
    water.close();
    for (const error of await Promise.all(first)) expect(error).toMatchObject({ name: "ConnectionLost", wasSent: true });
    expect(await failure(water.splash({}))).toMatchObject({ name: "ConnectionLost" });
    await fake.stop();
  });

  it("are rejected when no answer comes", async () => {
    const fake = await fakeServer();
    const water = await connected(fake.url, { answerWithinS: 0.2 });
    expect(await failure(water.splash({}))).toMatchObject({ name: "NoAnswer", message: expect.stringContaining("splash") });
    await fake.stop();
  });
});

describe("the water at points", () => {
  it("agrees with the surface of its tick, and a stream has every tick", async () => {
    const water = await connected(server.url, { room: "marina" });
    await water.setPaused({ paused: true });
    await water.splash({ xM: 1, zM: 1, depthM: 0.3 });
    const surface = await water.advance(20);
    const points = [[1, 1], [-2.3, 0.4], [0.1, 500]];
    const answer = await water.query(points);
    expect([answer.tick, answer.stateId, answer.timeS, ...answer.outside]).toEqual([surface.tick, surface.stateId, surface.timeS, 0, 0, 1]);
    for (const k of [0, 1]) expect(Math.abs(answer.elevationM[k] - surface.heightM(...points[k]))).toBeLessThanOrEqual(surface.quantumM);
    expect(Math.abs(answer.elevationM[0])).toBeGreaterThan(0.001);
    const ticks = [];
    for await (const { tick, outside } of water.streamQuery(points, { velocities: [[0, 1]] })) {
      expect([...outside]).toEqual([0, 0, 1]);
      if (ticks.push(tick) === 5) break;
      await water.step({ tickCount: 1 });
    }
    expect(ticks).toEqual([0, 1, 2, 3, 4].map((k) => answer.tick + k));
    expect(await failure(water.query([[0, NaN]]))).toMatchObject({ name: "Rejected", field: "query.z_m[0]", value: NaN });
    expect(await failure(water.query(new Float32Array(2 * 1025)))).toMatchObject({ name: "Rejected", message: expect.stringContaining("1024") });
    await water.setPaused({ paused: false });
  });
});

describe("a held clock", () => {
  it("makes exactly the ticks that are asked for, and repeats", async () => {
    const water = await connected(server.url, { room: "marina" });
    const hashes = [];
    const clock = await water.takeClock();
    let ack;
    for (let k = 0; k < 2; ++k) {
      await water.reset({ seed: 5 });
      await water.splash({ xM: 1, zM: 1, depthM: 0.3 });
      ack = await clock.step(40);
      hashes.push(ack.stateHash);
    }
    expect(hashes[0]).toBe(hashes[1]);
    expect(hashes[0]).not.toBe(0n);
    const answer = await water.query([[1, 1]]);
    expect(answer.tick).toBe(ack.appliedTick);
    expect((await clock.step()).appliedTick).toBe(answer.tick + 1);
    expect((await water.query([[1, 1]])).tick).toBe(answer.tick + 1);
    expect(water.clockPersonIds).toEqual([water.personId]);
    const other = await connected(server.url, { room: "marina" });
    expect(await failure(other.setPaused({ paused: true }))).toMatchObject({ name: "Rejected", reason: "CLOCK_HELD" });
    await clock.release();
    while ((await water.query([[1, 1]])).tick < answer.tick + 10);
    const short = await water.takeClock({ timeoutS: 0.2 });
    while (water.clockPersonIds.length === 0) await water.once("roomState");
    while (water.clockPersonIds.length > 0) await water.once("roomState");
    expect(await failure(short.step())).toMatchObject({ name: "Rejected" });
    await short.release();
  });
});

describe("a moved boat", () => {
  it("is where it was put, and gets the forces of the tick", async () => {
    const water = await connected(server.url, { room: "marina" });
    await water.setPaused({ paused: true });
    const { boatId } = await water.spawnBoat({ boat: { xM: 2, zM: 2 } });
    const own = () => water.boats.find((boat) => boat.boatId === boatId);
    while (!own()) await water.once("boatList");
    const { heightM, draughtM } = own();
    const lifts = [];
    let forces;
    for (const deeperM of [0, 0.05]) {
      const { appliedTick } = await water.moveBoat({ boatId, xM: 1.5, yM: heightM / 2 - draughtM - deeperM, zM: -1, headingRad: 0.5 });
      await water.step({ tickCount: 1 });
      forces = await water.hullForces();
      expect([forces.tick, forces.hulls.map((hull) => hull.boatId)]).toEqual([appliedTick + 1, [boatId]]);
      lifts.push(forces.hulls[0].hydrostatic.forceYN);
    }
    expect(lifts[0]).toBeGreaterThan(0);
    expect(lifts[1]).toBeGreaterThan(lifts[0]);
    let frame;
    do frame = await water.next("bodies");
    while (frame.tick < forces.tick);
    expect(frame.boat(boatId)).toMatchObject({ xM: expect.closeTo(1.5, 2), zM: expect.closeTo(-1, 2), headingRad: expect.closeTo(0.5, 2) });
    expect(await failure(water.moveBoat({ boatId, xM: NaN }))).toMatchObject({ name: "Rejected", field: "move_boat.x_m" });
    await water.moveBoat({ boatId, ends: true });
    await water.removeBoat({ boatId });
    await water.setPaused({ paused: false });
  });
});

describe("the connection", () => {
  const marina = ["--scene", `${repository}/tests/browser/marina.textproto`, "--grace", "60"];

  it("resumes with boat and loops after the server was killed and started again", async () => {
    const port = await freePort();
    const kept = [...marina, "--state-dir", join(folder, "state"), "--drain-s", "0"];
    const first = await startServer(port, kept);
    const water = await connected(first.url, { name: "Ada" });
    const { personId } = water;
    const { boatId } = await water.spawnBoat({ boat: { xM: 2, zM: 2 } });
    const frames = water.frames("bodies");
    await frames.next();
    await first.stop("SIGTERM");
    const [lost, resumed] = [water.isLive ? water.once("disconnected") : undefined, water.once("resumed")];
    await lost;
    expect(await failure(water.splash({}))).toMatchObject({ name: "ConnectionLost", wasSent: false });
    const second = await startServer(port, kept);
    try {
      expect((await resumed).personId).toBe(personId);
      let frame;
      do frame = (await frames.next()).value;
      while (!frame.boat(boatId));
      expect((await water.controlBoat({ boatId, throttleRatio: 0.5 })).appliedTick).toBeGreaterThan(0);
    } finally {
      await second.stop("SIGTERM");
    }
  });

  it("connects as a new person to a server that was killed and knows nothing", async () => {
    const port = await freePort();
    const first = await startServer(port, marina);
    const water = await connected(first.url);
    const [lost, connectedAgain] = [water.once("disconnected"), water.once("connected")];
    await first.stop("SIGKILL");
    expect((await lost).retryInS).toBeGreaterThanOrEqual(0.5);
    const second = await startServer(port, marina);
    try {
      expect((await connectedAgain).resumed).toBe(false);
      expect((await water.surface()).countX).toBe(64);
    } finally {
      await second.stop("SIGTERM");
    }
  });

  it("follows a draining server to another one", async () => {
    const other = await startServer(0, marina);
    try {
      const first = await startServer(0, [...marina, "--drain-s", "4", "--drain-to", `ws://127.0.0.1:${other.port}`]);
      const water = await connected(first.url);
      const told = [water.once("draining"), water.once("moved"), water.once("connected")];
      const ended = first.stop("SIGTERM");
      expect((await told[0]).goTo).toBe(`ws://127.0.0.1:${other.port}`);
      expect((await told[1]).url).toBe(`ws://127.0.0.1:${other.port}/ws`);
      await told[2];
      await ended;
      expect((await water.splash({})).appliedTick).toBeGreaterThan(0);
    } finally {
      await other.stop("SIGTERM");
    }
  });

  it("ends loops without an error after close(), and with one after a refusal", async () => {
    const refusals = [];
    const fake = await fakeServer({ answer: (message, socket) => message.case === "subscribe" && refusals.push(socket) });
    const [closing, refused] = [await connected(fake.url), await connected(fake.url)];
    const [a, b] = [closing.frames("surface"), refused.frames("surface")];
    const [ended, failed, waiting, unheard] = [a.next(), failure(b.next()), failure(refused.surface()), failure(closing.once("people"))];
    const closed = refused.once("closed");
    closing.close();
    expect(await ended).toEqual({ done: true, value: undefined });
    expect(await unheard).toMatchObject({ name: "ConnectionLost" });
    while (refusals.length < 2) await new Promise((resolve) => setTimeout(resolve, 10));
    for (const socket of refusals) socket.send(bytesOf({ case: "refusal", value: { message: "the room was closed" } }));
    for (const error of [await failed, await waiting, (await closed).error]) expect(error).toMatchObject({ name: "Refused", message: "the room was closed" });
    expect(await failure(refused.surface())).toMatchObject({ name: "Refused" });
    expect(await failure(refused.once("people"))).toMatchObject({ name: "Refused" });
    await fake.stop();
  });

  it("says in one sentence that the server speaks another major version", async () => {
    const fake = await fakeServer({ version: { major: 2, minor: 0 } });
    const error = await failure(connected(fake.url));
    expect(error).toMatchObject({ name: "Refused" });
    expect(error.message).toMatch(/^the server speaks version 2\.0 of the wire, this client 1\.\d+; reload the page, or update the client$/);
    await fake.stop();
  });

  it("is refused for a room that there is not, with those that there are, and gives up on a server that is not there", async () => {
    const error = await failure(connected(server.url, { room: "nowhere" }));
    expect(error).toMatchObject({ name: "Refused", message: "there is no room nowhere", rooms: expect.arrayContaining(["marina", "tank"]) });
    const port = await freePort();
    const lost = await failure(connected(`localhost:${port}`, { patienceS: 1 }));
    expect(lost).toMatchObject({ name: "ConnectionLost", message: expect.stringMatching(/^no connection to ws:\/\/localhost:\d+\/ws within 1 s: .*ECONNREFUSED/) });
    expect(await failure(connected("ftp://host"))).toMatchObject({ name: "TypeError", message: expect.stringContaining("http://host:8080") });
  });

  it("takes the room and the token of the page's address", async () => {
    expect((await connected(`${server.url}?room=marina#token=`)).greeting.room).toBe("marina");
    expect((await connected(`127.0.0.1:${server.port}/ws/tank`)).greeting.room).toBe("tank");
  });

  it("carries a hundred clients in one process", async () => {
    const crowd = await Promise.all(Array.from({ length: 100 }, (_, k) => connected(server.url, { room: "marina", name: `client ${k}` })));
    for (const water of crowd) water.subscribe("surface", { rateHz: 2, level: "coarse" });
    const frames = await Promise.all(crowd.map((water) => water.surface()));
    expect(frames.every(({ heightsM }) => heightsM.every(Number.isFinite))).toBe(true);
    expect(new Set(crowd.map(({ personId }) => personId)).size).toBe(100);
    const acks = await Promise.all(crowd.map((water) => water.placeGauge({ xM: 0, zM: 0 }).then((ack) => ack.appliedTick, (error) => error.reason)));
    expect(acks.every((ack) => typeof ack === "number" || ["BUSY", "OUT_OF_RANGE", "FORBIDDEN"].includes(ack))).toBe(true);
  });
});

describe("a reader that is slower than the water", () => {
  it("loses the oldest frames and counts them, and its queue keeps its bound", async () => {
    const sent = 200;
    const surface = readFileSync(join(kGolden, "surface_16.bin"));
    const fake = await fakeServer({ answer: (message, socket) => message.case === "subscribe" && message.value.maxRateHz > 0 && Array.from({ length: sent }, () => socket.send(surface)) });
    const water = await connected(fake.url);
    const [narrow, wide] = [water.frames("surface", { capacity: 3 }), water.frames("surface")];
    while (narrow.dropped < sent - 3) {
      await new Promise((resolve) => setTimeout(resolve, 5));
      expect(narrow.waitingCount).toBeLessThanOrEqual(3);
    }
    expect([narrow.dropped, narrow.waitingCount, wide.dropped, wide.waitingCount]).toEqual([sent - 3, 3, sent - 16, 16]);
    expect(water.dropped).toEqual({ surface: 2 * sent - 19 });
    for (let k = 0; k < 3; ++k) expect((await narrow.next()).done).toBe(false);
    await narrow.return();
    expect(water.dropped).toEqual({ surface: 2 * sent - 19 });
    expect(() => water.frames("surface", { capacity: Infinity })).toThrow(RangeError);
    await fake.stop();
  });
});

describe("frames of every kept version of the wire", () => {
  const cases = JSON.parse(readFileSync(join(kGolden, "golden.json"), "utf8"));
  const layerOf = (golden) => golden.layer.replace("LAYER_", "").toLowerCase();
  const chain = (golden) => (golden.follows ? [...chain(cases.find(({ file }) => file === golden.follows)), golden] : [golden]);
  let fake;
  /** Messages that the server sends when the client subscribes. */
  let messages;
  beforeAll(async () => {
    fake = await fakeServer({ answer: (message, socket) => message.case === "subscribe" && messages.forEach((bytes) => socket.send(bytes)) });
  });
  afterAll(() => fake?.stop());

  it.each(cases.filter(({ kind, verdict }) => kind === "frame" && verdict === "ok"))("reads $file", async (golden) => {
    const files = chain(golden);
    messages = files.map(({ file }) => readFileSync(join(kGolden, file)));
    const water = await connected(fake.url);
    const frames = water.frames(layerOf(golden));
    let frame;
    for (const _ of files) frame = (await frames.next()).value;
    // One tick is 2^53 + 1, which no number of JavaScript is.
    expect(frame).toMatchObject({ layer: layerOf(golden), tick: Number(golden.tick), timeS: golden.time_s, level: "full" });
    const close = (found, wanted, within) => {
      expect(found).toHaveLength(wanted.length);
      for (let k = 0; k < wanted.length; ++k) if (!(Math.abs(found[k] - wanted[k]) <= within)) expect.fail(`[${k}]: ${found[k]}, not ${wanted[k]}`);
    };
    if (frame.layer === "surface") {
      expect([frame.countX, frame.countZ, frame.lengthM, frame.widthM]).toEqual([golden.resolution_count, golden.count_z ?? golden.resolution_count, golden.side_m, golden.width_m ?? golden.side_m]);
      close(frame.heightsM, golden.elevation_m.map(Math.fround), 1e-7);
      expect(frame.heightM(frame.xM(1), frame.zM(2))).toBeCloseTo(golden.elevation_m[2 * frame.countX + 1], 6);
    } else if (frame.layer === "foam") expect([...frame.samples]).toEqual(golden.foam);
    else if (frame.layer === "particles") {
      close(frame.positionsM, golden.position_m, 1e-4);
      close(frame.velocitiesMps, golden.velocity_mps, 1e-5);
      close(frame.foam, golden.foam.map((white) => white / 255), 1e-6);
      expect(frame.count).toBe(golden.count);
    } else if (frame.layer === "bodies") {
      expect([...frame.ids]).toEqual(golden.bodies.map((body) => body.boat_id));
      close(frame.positionsM, golden.bodies.flatMap((body) => body.position_m), 1e-6);
      close(frame.headingsRad, golden.bodies.map((body) => body.heading_rad), 1e-6);
    } else {
      expect([...frame.ids]).toEqual(golden.floaters.map((floater) => floater.floater_id));
      close(frame.positionsM, golden.floaters.flatMap((floater) => floater.position_m), 1e-6);
      close(frame.rotations, golden.floaters.flatMap((floater) => floater.rotation), 1e-3);
      close(frame.sizesM, golden.floaters.map((floater) => floater.size_m), 1e-6);
    }
  });

  it("counts those that break a rule, and takes none of them", async () => {
    const bad = cases.filter(({ verdict }) => verdict === "bad_frame");
    messages = bad.map(({ file }) => readFileSync(join(kGolden, file)));
    const water = await connected(fake.url);
    const frames = Object.fromEntries(water.greeting.layers.map((layer) => [layer, water.frames(layer)]));
    // Once for each subscription; those to a keyframe after damage send them again.
    while (water.damagedCount < bad.length) await water.once("stats");
    expect(Object.values(frames).map(({ waitingCount }) => waitingCount)).toEqual(Object.values(frames).map(() => 0));
    expect(water.isLive).toBe(true);
  });
});
