// Commands, queries, the clock and boats through the npm package spindrift-client, and the package itself.
import { execFile, spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { promisify } from "node:util";

import { repository } from "../browser/server.mjs";
import { kClientDist, npm } from "./installed_client.mjs";
import { client, connected, failure, fakeServer, folder, frameOf, server, started } from "./javascript_client.mjs";

const run = promisify(execFile);

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
    const other = await started(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--guests", "viewer"]);
    const water = await connected(other.url);
    expect(water.role).toBe("viewer");
    expect(await failure(water.splash({}))).toMatchObject({ name: "Rejected", reason: "FORBIDDEN" });
    expect((await water.surface()).countX).toBe(144);
  });

  it("know parameters, people, boats and gauges of the room", async () => {
    const water = await connected(server.url, { room: "marina", name: "Ada" });
    const { boatId } = await water.spawnBoat({ boat: { xM: 2, zM: 2 } });
    const frame = await frameOf(water, "bodies", (each) => each.boat(boatId));
    expect(frame.ids).toContain(boatId);
    expect(frame.boat(boatId).xM).toBeCloseTo(2, 0);
    await water.controlBoat({ boatId, throttleRatio: 1 });
    await frameOf(water, "bodies", (each) => each.boat(boatId).speedMps > 0.05);
    expect(water.boats.find((boat) => boat.boatId === boatId).lengthM).toBeGreaterThan(0);
    const own = () => water.people.find(({ personId }) => personId === water.personId);
    while (own()?.boatIds.length !== 1) await water.once("people");
    expect(own()).toMatchObject({ name: "Ada", boatIds: [boatId], role: water.role });
    const { gaugeId } = await water.placeGauge({ xM: 1, zM: 1 });
    const ownGauge = ({ gauges }) => gauges.find((gauge) => gauge.gaugeId === gaugeId && !gauge.unread);
    const series = await water.gauge(ownGauge(await frameOf(water, "diagnostics", ownGauge)).name);
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
  });

  it("are rejected when no answer comes", async () => {
    const fake = await fakeServer();
    const water = await connected(fake.url, { answerWithinS: 0.2 });
    expect(await failure(water.splash({}))).toMatchObject({ name: "NoAnswer", message: expect.stringContaining("splash") });
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
    const frame = await frameOf(water, "bodies", ({ tick }) => tick >= forces.tick);
    expect(frame.boat(boatId)).toMatchObject({ xM: expect.closeTo(1.5, 2), zM: expect.closeTo(-1, 2), headingRad: expect.closeTo(0.5, 2) });
    expect(await failure(water.moveBoat({ boatId, xM: NaN }))).toMatchObject({ name: "Rejected", field: "move_boat.x_m" });
    await water.moveBoat({ boatId, ends: true });
    await water.removeBoat({ boatId });
    await water.setPaused({ paused: false });
  });
});
