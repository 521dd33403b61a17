// Foxglove's own client at /foxglove of the real server.
import { rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { command, startServer, temporaryFolder } from "../browser/server.mjs";
import { Client } from "./client.mjs";
import { elements, heightsOf, Studio } from "./studio.mjs";

const kPlayer = "a-player-for-the-foxglove-test";
const kOperator = "an-operator-for-the-foxglove-test";

const folder = temporaryFolder("foxglove");
let server;

beforeAll(async () => {
  const pool = join(folder, "pool.textproto");
  // 64 x 32 cells of 0.5 m.
  writeFileSync(
    pool,
    `name: "pool"
     wave { resolution_count: 64 side_m: 32 width_m: 16 depth_m: 2 damping_per_s: 0.2 }
     particles { count: 1024 layers_count: 2 boundary_x: BOUNDARY_WALL boundary_z: BOUNDARY_WALL }
     coupling {} foam { surface: true } boats { capacity_count: 4 boats { x_m: 3 z_m: -4 heading_deg: 90 } }
     floaters { floaters { kind: FLOATER_KIND_BARREL x_m: -5 z_m: 2 } }
     gauges { name: "middle" x_m: 0 z_m: 0 }
     stream { frame_rate_hz: 20 }`,
  );
  writeFileSync(join(folder, "tokens"), `player ${kPlayer}\noperator ${kOperator}\n`);
  server = await startServer(0, ["--scene", pool, "--room", `other=${pool}`, "--foxglove", "--guests", "viewer", "--tokens-file", join(folder, "tokens")]);
});
afterAll(async () => {
  expect(await server?.stop("SIGTERM")).toEqual({ code: 0, signal: null });
  rmSync(folder, { recursive: true });
});

const connect = (options = {}, port = server.port) => new Studio(port, { token: kOperator, ...options });

const opened = [];
afterEach(() => Promise.all(opened.splice(0).map((studio) => studio.close())));
/** Returns a client that knows channels and services; it is closed after the test. */
async function ready(options) {
  const studio = connect(options);
  opened.push(studio);
  await studio.ready();
  return studio;
}

describe("a connection", () => {
  it.each(["foxglove.sdk.v1", "foxglove.websocket.v1"])("speaks %s and says what there is", async (protocol) => {
    const studio = await ready({ protocols: [protocol] });
    expect(studio.ws.protocol).toBe(protocol);
    const info = await studio.next("serverInfo");
    expect(info.name).toMatch(/^spindrift .*, room main$/);
    expect(info.capabilities).toEqual(["time", "parameters", "parametersSubscribe", "services"]);
    expect([...studio.channels.keys()].sort()).toEqual(
      ["/boats", "/diagnostics", "/floaters", "/gauges", "/layers/bodies", "/layers/floaters", "/layers/foam", "/layers/particles", "/layers/surface", "/tf", "/water/foam", "/water/particles", "/water/surface"]);
    expect([...studio.services.keys()]).toEqual(["/splash", "/reset"]);
    expect(studio.errors).toEqual([]);
  });

  it("may be to another room, and to none that does not exist", async () => {
    const studio = await ready({ path: "/foxglove/other" });
    expect((await studio.next("serverInfo")).name).toMatch(/room other$/);
    expect(await connect({ path: "/foxglove/nowhere" }).refused).toBe(404);
  });

  it("needs a subprotocol of Foxglove, and a server that was asked to serve it", async () => {
    expect(await connect({ protocols: ["spindrift.v1"] }).refused).toBe(400);
    const plain = await startServer(0, ["--scene", join(folder, "pool.textproto")]);
    try {
      expect(await connect({}, plain.port).refused).toBe(404);
    } finally {
      await plain.stop("SIGTERM");
    }
  });

  it("is refused to pages of other origins", async () => {
    expect(await connect({ origin: "https://elsewhere.example" }).refused).toBe(403);
  });

  it("ends with a readable status if its token is unknown", async () => {
    const studio = connect({ token: "not-a-token-of-this-server" });
    const { message } = await studio.next("status", ({ level }) => level === 2);
    expect(message).toMatch(/token/);
    expect(message).not.toContain("not-a-token-of-this-server");
    expect((await studio.closed).code).toBe(4401);
  });

  it("is a person of the room like others", async () => {
    const studio = await ready();
    const page = await Client.greeted(server.port, { minor: 11 });
    const people = await page.next((message) => message.kind === "people" && message.people.some(({ name }) => name === "Foxglove"));
    expect(people.people.length).toBeGreaterThanOrEqual(2);
    await page.close();
  });
});

describe("channels", () => {
  let studio;
  beforeAll(async () => {
    studio = connect();
    await studio.ready();
  });
  afterAll(() => studio.close());

  it("have the surface as a grid, and a splash is in it at its position", async () => {
    const surface = studio.subscribe("/water/surface");
    const before = await surface.next();
    expect(before.columnCount).toBe(64);
    expect(before.pose.position).toMatchObject({ x: -16, y: -8 });
    expect(before.cellSize).toMatchObject({ x: 0.5, y: 0.5 });
    expect(before.data.byteLength).toBe(64 * 32 * 4);
    expect(await studio.call("/splash", '{"x_m": 8.25, "z_m": 4.25, "radius_m": 1.5, "depth_m": 0.8}')).toMatchObject({ applied_tick: expect.any(Number) });
    const after = await surface.next((grid) => Math.min(...heightsOf(grid)) < -0.2);
    const heights = heightsOf(after);
    const lowest = heights.indexOf(Math.min(...heights));
    // y of the grid is -z: row 7 of 32 from the corner at y = -8 m is y = -4.25 m.
    expect(Math.abs((lowest % 64) - 48)).toBeLessThanOrEqual(3);
    expect(Math.abs(Math.floor(lowest / 64) - 7)).toBeLessThanOrEqual(3);
    studio.client.unsubscribe(surface.id);
  });

  it("have particles as a cloud with finite numbers", async () => {
    const particles = studio.subscribe("/water/particles");
    const cloud = await particles.next(({ data }) => data.byteLength > 0);
    expect(cloud.frameId).toBe("water");
    const points = elements(cloud, cloud.pointStride);
    expect(points.length).toBe(1024);
    for (const point of points) {
      expect(Object.values(point).every(Number.isFinite)).toBe(true);
      expect(Math.abs(point.x)).toBeLessThanOrEqual(17);
      expect(point.density_ratio).toBeGreaterThanOrEqual(0.5);
    }
    studio.client.unsubscribe(particles.id);
  });

  it("have boats, their transforms, floaters, foam, gauges, and the layers as they are", async () => {
    const of = Object.fromEntries(["/boats", "/tf", "/floaters", "/water/foam", "/gauges", "/layers/surface", "/diagnostics"].map((topic) => [topic, studio.subscribe(topic)]));
    // The streams share one log here, in the order of what is asked for.
    const read = async (topic, accept) => {
      studio.log.message.length = 0;
      return of[topic].next(accept);
    };
    const { transforms } = await read("/tf");
    expect(transforms).toHaveLength(1);
    const { childFrameId, translation, rotation } = transforms[0];
    expect(childFrameId).toBe("boat_1");
    expect(translation.x).toBeCloseTo(3, 0);
    expect(translation.y).toBeCloseTo(4, 0);
    // Heading 90 degrees points along +z, -y here: a turn by -90 degrees about z.
    expect(Math.abs(rotation.z)).toBeCloseTo(Math.SQRT1_2, 1);
    expect(Math.sign(rotation.z * rotation.w)).toBe(-1);
    const boats = await read("/boats", ({ entities }) => entities.length === 1);
    expect(boats.entities[0].cubes[0].size.x).toBeGreaterThan(1);
    expect((await read("/floaters")).entities[0].cylinders).toHaveLength(1);
    expect((await read("/water/foam")).fields[0].name).toBe("foam");
    expect(await read("/gauges")).toMatchObject({ name: "middle", xM: 0 });
    expect((await read("/layers/surface")).codec.case).toBe("surfaceFixed16");
    expect((await read("/diagnostics")).particleCount).toBe(1024);
    for (const { id } of Object.values(of)) studio.client.unsubscribe(id);
  });

  it("come at a bounded rate, with a time that only grows, and stop when they are not wanted", async () => {
    studio.log.time.length = 0;
    const tf = studio.subscribe("/tf");
    const from = Number((await studio.next("time")).timestamp);
    const begun_ms = performance.now();
    let count = 0;
    let last = from;
    while (last < from + 3e9) {
      const { timestamp } = await studio.next("time");
      expect(Number(timestamp)).toBeGreaterThan(last);
      last = Number(timestamp);
      ++count;
    }
    // 15 per second, with the tolerance of the outbox.
    expect(count).toBeLessThanOrEqual((1.2 * 15 * (performance.now() - begun_ms)) / 1000 + 5);
    studio.client.unsubscribe(tf.id);
    await studio.call("/splash", "{}"); // answered after the unsubscription
    studio.log.message.length = 0;
    await new Promise((done) => setTimeout(done, 1000));
    expect(studio.log.message.length).toBeLessThanOrEqual(1);
  });
});

describe("a room that stands still", () => {
  it("is shown to every new channel, also of a layer that is watched already", async () => {
    const pause = async (paused) => expect((await command(server, { set_paused: { paused } }, { room: "other", token: kOperator })).status).toBe(200);
    await pause(true);
    const studio = await ready({ path: "/foxglove/other" });
    for (const topic of ["/water/surface", "/layers/surface", "/boats", "/tf", "/water/particles"]) {
      const channel = studio.subscribe(topic);
      await channel.next();
    }
    await pause(false);
  });
});

describe("parameters", () => {
  it("are read, set, and told to who watches them", async () => {
    const studio = await ready();
    studio.client.getParameters([], "all");
    const all = await studio.next("parameterValues", ({ id }) => id === "all");
    const name = "wave.damping_per_s";
    expect(all.parameters.find((one) => one.name === name)).toEqual({ name, value: 0.2, type: "float64" });
    const other = await ready({ token: "" });
    other.client.subscribeParameterUpdates([name]);
    other.client.getParameters([name], "seen"); // it is answered once the subscription has been read
    await other.next("parameterValues", ({ id }) => id === "seen");
    studio.client.setParameters([{ name, value: 0.35 }], "set");
    expect((await studio.next("parameterValues", ({ id }) => id === "set")).parameters).toEqual([{ name, value: 0.35, type: "float64" }]);
    expect((await other.next("parameterValues", ({ id }) => id === undefined)).parameters).toEqual([{ name, value: 0.35, type: "float64" }]);
    studio.client.setParameters([{ name, value: 1e9 }, { name: "no.such", value: 1 }, { name, value: "much" }], "wrong");
    expect((await studio.next("parameterValues", ({ id }) => id === "wrong")).parameters).toContainEqual({ name, value: 0.35, type: "float64" });
    const told = studio.log.status.map(({ message }) => message).join("\n");
    expect(told).toMatch(/damping/);
    expect(told).toMatch(/no\.such/);
    expect(told).toMatch(/has to be a number/);
  });
});

describe("services", () => {
  it("start the scene again", async () => {
    const studio = await ready();
    studio.subscribe("/tf");
    await studio.until(() => studio.log.time.length > 3);
    expect(await studio.call("/reset", "")).toMatchObject({ applied_tick: expect.any(Number) });
    await studio.next("status", ({ message }) => /started again/.test(message));
    await studio.until(() => studio.log.time.some(({ timestamp }, k, all) => k > 0 && timestamp < all[k - 1].timestamp), "a time that goes back");
  });

  it("are refused to viewers, and requests that make no sense, with a readable reason", async () => {
    const viewer = await ready({ token: "" });
    expect(await viewer.call("/splash", "{}")).toMatchObject({ op: "serviceCallFailure", message: expect.stringMatching(/viewer|player/) });
    await viewer.next("status", ({ level, message }) => level === 2 && /viewer|player/.test(message));
    viewer.client.setParameters([{ name: "wave.damping_per_s", value: 0.1 }], "no");
    await viewer.next("parameterValues", ({ id }) => id === "no");

    const player = await ready({ token: kPlayer });
    const failure = (pattern) => ({ op: "serviceCallFailure", message: expect.stringMatching(pattern) });
    expect(await player.call("/splash", '{"radius_m": 1e9}')).toMatchObject(failure(/radius_m/));
    expect(await player.call("/splash", '{"diameter": 1}')).toMatchObject(failure(/diameter/));
    expect(await player.call("/splash", '{}},"reset":{')).toMatchObject(failure(/JSON/));
    expect(await player.call("/splash", "[1, 2]")).toMatchObject(failure(/JSON object/));
    expect(await player.call("/splash", "{}")).toMatchObject({ applied_tick: expect.any(Number) });
  });
});

describe("hostile clients", () => {
  /** Sends what is given and returns the statuses that it causes, once the server has read it all. */
  async function statusesOf(...messages) {
    const studio = await ready();
    for (const message of messages) studio.ws.send(message);
    studio.client.getParameters([], "end");
    await studio.next("parameterValues", ({ id }) => id === "end");
    await studio.close();
    return studio.log.status.map(({ message }) => message);
  }
  const json = JSON.stringify;

  it("are told what is wrong, once per message", async () => {
    expect(await statusesOf("{", "[]", '"x"', "", "null", `${"[".repeat(4000)}`)).toHaveLength(6);
    const [unknown] = await statusesOf(json({ op: "fly\u202e" }));
    expect(unknown).toMatch(/op 'fly' is not supported/);
    for (const binary of [[], [0], [1, 0, 0, 0, 0], [255], [2], [2, 1, 0, 0, 0, 1, 0, 0, 0, 255, 255, 255, 255]])
      expect(await statusesOf(Buffer.from(binary)), binary).toHaveLength(1);
    expect(await statusesOf(json({ op: "subscribe" }), json({ op: "subscribe", subscriptions: 5 }), json({ op: "setParameters" }), json({ op: "unsubscribe", subscriptionIds: {} }))).toEqual([]);
    const wrong = [{}, null, { id: -1, channelId: 1 }, { id: 1.5, channelId: 1 }, { id: 1, channelId: 0 }, { id: 1, channelId: 99 }, { id: 1, channelId: "1" }, { id: 2 ** 40, channelId: 1 }];
    expect(await statusesOf(json({ op: "subscribe", subscriptions: wrong }))).toEqual([expect.stringMatching(/\(and 7 more\)$/)]);
    expect(await statusesOf(json({ op: "unsubscribe", subscriptionIds: [1, "x", null, -1, 0.5] }))).toHaveLength(1);
  });

  it("get one subscription per channel, however many they ask for", async () => {
    const studio = await ready();
    const { id: channelId } = studio.channels.get("/tf");
    for (let first = 0; first < 10_000; first += 400)
      studio.ws.send(json({ op: "subscribe", subscriptions: Array.from({ length: 400 }, (_, k) => ({ id: first + k, channelId })) }));
    studio.client.getParameters([], "end");
    await studio.next("parameterValues", ({ id }) => id === "end");
    expect(studio.log.status).toHaveLength(25);
    studio.log.message.length = 0;
    await studio.until(() => studio.log.message.length >= 5);
    expect(studio.log.message.every(({ subscriptionId }) => subscriptionId === 0)).toBe(true);
  });

  it("have a bounded number of calls under way", async () => {
    const studio = await ready();
    for (let k = 0; k < 5; ++k) studio.client.setParameters(Array.from({ length: 60 }, () => ({ name: "wave.damping_per_s", value: 0.2 })), `${k}`);
    await studio.until(() => new Set(studio.log.parameterValues.map(({ id }) => id)).size === 5, "five answers");
    expect(studio.log.status.map(({ message }) => message).join("\n")).toMatch(/64 commands are under way, the limit/);
  });

  it("are closed for a message of 1 MB, and for too many messages", async () => {
    const big = await ready();
    big.ws.send(json({ op: "subscribe", subscriptions: "x".repeat(1 << 20) }));
    expect((await big.closed).code).toBe(1009);
    const many = await ready();
    for (let k = 0; k < 5000; ++k) many.ws.send("{}");
    expect([1008, 1013]).toContain((await many.closed).code);
  });

  it("leave the server running", async () => {
    expect((await fetch(`${server.url}healthz`)).status).toBe(200);
    const studio = await ready();
  });
});
