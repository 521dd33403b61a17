// spindrift-mcp of the installed package, used by the client of the Model Context Protocol's own library.
import { spawnSync } from "node:child_process";
import { rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Client } from "@modelcontextprotocol/client";
import { StdioClientTransport } from "@modelcontextprotocol/client/stdio";

import { repository, startServer } from "../browser/server.mjs";
import { installClient } from "./installed_client.mjs";

const kTokens = { operator: "operator-token-of-this-test", viewer: "viewer-token-of-this-test" };
const opened = [];
let folder;
let server;
let decode;

beforeAll(async () => {
  folder = installClient({ withAgent: true });
  ({ decode } = await import(pathToFileURL(createRequire(join(folder, "package.json")).resolve("fast-png")).href));
  writeFileSync(join(folder, "tokens"), Object.entries(kTokens).map(([role, token]) => `${role} ${token}\n`).join(""), { mode: 0o600 });
  const scenes = ["--scene", `${repository}/tests/browser/scene.textproto`, ...["marina", "tank"].flatMap((name) => ["--room", `${name}=${repository}/tests/browser/${name}.textproto`])];
  server = await startServer(0, [...scenes, "--tokens-file", join(folder, "tokens"), "--guests", "none"]);
});
afterEach(async () => {
  for (const client of opened.splice(0)) await client.close();
});
afterAll(async () => {
  await server?.stop("SIGTERM");
  if (folder) rmSync(folder, { recursive: true, force: true });
});

/** An agent with the token of a role. Its calls give all that is answered, JSON and pictures decoded, and as `value` the last of it. */
async function agent(role, url = server.url) {
  const client = new Client({ name: "test", version: "1" });
  const command = join(folder, "node_modules/.bin/spindrift-mcp");
  await client.connect(new StdioClientTransport({ command, args: [url], env: { ...process.env, SPINDRIFT_TOKEN: kTokens[role] ?? "" } }));
  opened.push(client);
  return {
    client,
    async call(name, given = {}) {
      const { content, isError = false } = await client.callTool({ name, arguments: given });
      const read = content.map((each) => (each.type === "image" ? decode(Buffer.from(each.data, "base64")) : /^[[{]/.test(each.text) ? JSON.parse(each.text) : each.text));
      return { isError, read, value: read.at(-1) };
    },
  };
}

describe("an agent", () => {
  it("finds rooms, scenes, commands and what a room is", async () => {
    const { client, call } = await agent("operator");
    expect((await client.listTools()).tools.map(({ name }) => name).sort()).toEqual(["command", "commands", "gauge", "list_rooms", "list_scenes", "open_room", "parameters", "picture", "query", "room"]);
    expect((await call("list_rooms")).value.map(({ name }) => name).sort()).toEqual(["main", "marina", "tank"]);
    expect((await call("list_scenes")).value).toContain("harbor");
    expect((await call("commands")).value).toMatch(/^splash\n {2}xM: x, -500 to 500 m; /);
    const about = (await call("room", { room: "marina" })).value;
    expect(about).toMatchObject({ room: "marina", scene: "marina", lengthM: 24, role: "operator", hasBoats: true, isPaused: false });
    expect(about.people).toMatchObject([{ name: "agent", role: "operator" }]);
  });

  it("acts, and sees in a picture what it did", async () => {
    const { call } = await agent("operator");
    const room = "marina";
    await call("command", { room, command: "setPaused", fields: { paused: true } });
    await call("command", { room, command: "reset" });
    const { boatId } = (await call("command", { room, command: "spawnBoat", fields: { boat: { xM: -6, zM: 6 } } })).value;
    expect(boatId).toBeGreaterThan(0);
    const splash = await call("command", { room, command: "splash", fields: { xM: 6, zM: 2, depthM: 0.3, radiusM: 2 } });
    expect(splash).toMatchObject({ isError: false, value: { appliedTick: expect.any(Number) } });
    const { appliedTick } = (await call("command", { room, command: "step", fields: { tickCount: 12 } })).value;
    let shown;
    do shown = await call("picture", { room, widthPx: 96 });
    while (shown.value.tick < appliedTick + 12);
    const [{ width, height, channels, data }, about] = shown.read;
    expect([width, height, channels, about.metresPerPixel]).toEqual([96, 96, 3, 0.25]);
    const at = (xM, zM) => [...data.slice(3 * (Math.floor((zM + 12) / 0.25) * width + Math.floor((xM + 12) / 0.25)))].slice(0, 3);
    const [red, , blue] = at(-6, 6);
    expect(red).toBeGreaterThan(2 * blue);
    expect(about.lowestM).toBeLessThan(-0.05);
    const [dent, calm] = [at(6, 2), at(-10, 10)].map((color) => color.reduce((a, b) => a + b));
    expect(dent).toBeLessThan(calm - 30);
    await call("command", { room, command: "setPaused", fields: { paused: false } });
  });

  it("reads gauges and sets parameters", async () => {
    const { call } = await agent("operator");
    const room = "main";
    const { gaugeId } = (await call("command", { room, command: "placeGauge", fields: { xM: 1, zM: 0 } })).value;
    let gauge;
    do gauge = (await call("room", { room })).value.gauges.find((each) => each.gaugeId === gaugeId && !each.unread);
    while (!gauge);
    const series = (await call("gauge", { room, gauge: gauge.name, count: 5 })).value;
    expect(series.timeS.length).toBeGreaterThan(0);
    expect(series.timeS.length).toBeLessThanOrEqual(5);
    expect(series.elevationM).toHaveLength(series.timeS.length);
    await call("command", { room, command: "setParameter", fields: { path: "wave.damping_per_s", value: 0.7 } });
    let parameter;
    do [parameter] = (await call("parameters", { room, contains: "damping" })).value;
    while (parameter.value !== 0.7);
    expect(parameter).toMatchObject({ path: "wave.damping_per_s", min: 0, unit: "1/s" });
  });

  it("asks for the water at points", async () => {
    const { call } = await agent("viewer");
    const { isError, value } = await call("query", { room: "marina", points: [[1, 2], [500, 0]] });
    expect(isError).toBe(false);
    expect(value).toMatchObject({ tick: expect.any(Number), outside: [0, 1], wetRatio: [1, 0] });
    expect(value.depthM[0]).toBeGreaterThan(0);
    expect((await call("query", { room: "marina", points: [] })).isError).toBe(true);
    expect(await call("command", { room: "marina", command: "query" })).toMatchObject({ isError: true });
  });

  it("draws the particles of a room without a surface", async () => {
    const { call } = await agent("viewer");
    const { read, value } = await call("picture", { room: "tank", widthPx: 64 });
    expect(read[0]).toMatchObject({ width: 64, channels: 3 });
    expect(value.highestM).toBeGreaterThan(value.lowestM);
    expect(new Set(read[0].data).size).toBeGreaterThan(10);
  });

  it("learns from refusals what it did wrong", async () => {
    const { call } = await agent("operator");
    const beyond = await call("command", { room: "main", command: "splash", fields: { radiusM: 1000 } });
    expect(beyond).toMatchObject({ isError: true, value: { error: "Rejected", reason: "OUT_OF_RANGE", field: "splash.radius_m", bound: { max: 100, unit: "m" } } });
    const unknown = await call("command", { room: "main", command: "splash", fields: { radius: 1 } });
    expect(unknown).toMatchObject({ isError: true, value: { error: "TypeError", message: expect.stringContaining("radiusM") } });
    expect(await call("command", { room: "main", command: "spawnFloater", fields: { floater: { kind: "DUCK" } } })).toMatchObject({ isError: true, value: { error: "TypeError" } });
    expect(await call("room", { room: "nowhere" })).toMatchObject({ isError: true, value: { error: "Refused", message: "there is no room nowhere" } });
    expect((await call("command", { command: "sink" })).isError).toBe(true);
    expect((await call("picture", { room: "main", widthPx: 1e6 })).isError).toBe(true);
  });

  it("has the role that its token gives", async () => {
    const viewer = await agent("viewer");
    expect((await viewer.call("room", { room: "main" })).value.role).toBe("viewer");
    expect(await viewer.call("command", { room: "main", command: "splash" })).toMatchObject({ isError: true, value: { reason: "FORBIDDEN" } });
    expect((await viewer.call("open_room", { room: "more", scene: "still_pool" })).isError).toBe(true);
    const guest = await agent("none");
    expect((await guest.call("room", { room: "main" })).isError).toBe(true);
    const operator = await agent("operator");
    expect((await operator.call("open_room", { room: "more", scene: "wave_only" })).value).toEqual({ room: "more", scene: "wave_only" });
    expect((await operator.call("room", { room: "more" })).value.scene).toBe("wave_only");
  });
});

describe("spindrift-mcp", () => {
  it("explains its use, and what it lacks", () => {
    const run = (program, ...options) => spawnSync(process.execPath, [program, ...options], { encoding: "utf8" });
    const installed = join(folder, "node_modules/spindrift-client/mcp.js");
    expect(run(installed, "--help").stdout).toMatch(/^usage: spindrift-mcp \[URL\]/);
    expect(run(installed, "--depth", "3")).toMatchObject({ status: 2, stderr: expect.stringMatching(/^spindrift-mcp: Unknown option '--depth'/) });
    expect(run(installed, "a", "b")).toMatchObject({ status: 2, stderr: expect.stringContaining("one URL is expected") });
    rmSync(join(folder, "node_modules/zod"), { recursive: true });
    expect(run(installed)).toMatchObject({ status: 2, stderr: expect.stringMatching(/^spindrift-mcp: install what it needs besides: npm install @modelcontextprotocol\/server zod/) });
  });
});
