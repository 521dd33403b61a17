// The connection of the npm package spindrift-client, with the real server and with one that this test writes, and frames of every version.
import { readFileSync } from "node:fs";
import { join } from "node:path";

import { freePort, repository } from "../browser/server.mjs";
import { bytesOf, client, connected, failure, fakeServer, folder, server, started } from "./javascript_client.mjs";

const kGolden = join(repository, "tests/golden");

describe("the connection", () => {
  const marina = ["--scene", `${repository}/tests/browser/marina.textproto`, "--grace", "60"];

  it("resumes with boat and loops after the server was killed and started again", async () => {
    const port = await freePort();
    const kept = [...marina, "--state-dir", join(folder, "state"), "--drain-s", "0"];
    const first = await started(port, kept);
    const water = await connected(first.url, { name: "Ada" });
    const { personId } = water;
    const { boatId } = await water.spawnBoat({ boat: { xM: 2, zM: 2 } });
    const frames = water.frames("bodies");
    await frames.next();
    await first.stop("SIGTERM");
    const [lost, resumed] = [water.isLive ? water.once("disconnected") : undefined, water.once("resumed")];
    await lost;
    expect(await failure(water.splash({}))).toMatchObject({ name: "ConnectionLost", wasSent: false });
    const second = await started(port, kept);
    expect((await resumed).personId).toBe(personId);
    let frame;
    do frame = (await frames.next()).value;
    while (!frame.boat(boatId));
    expect((await water.controlBoat({ boatId, throttleRatio: 0.5 })).appliedTick).toBeGreaterThan(0);
  });

  it("connects as a new person to a server that was killed and knows nothing", async () => {
    const port = await freePort();
    const first = await started(port, marina);
    const water = await connected(first.url);
    const [lost, connectedAgain] = [water.once("disconnected"), water.once("connected")];
    await first.stop("SIGKILL");
    expect((await lost).retryInS).toBeGreaterThanOrEqual(0.5);
    const second = await started(port, marina);
    expect((await connectedAgain).resumed).toBe(false);
    expect((await water.surface()).countX).toBe(64);
  });

  it("follows a draining server to another one", async () => {
    const other = await started(0, marina);
    const first = await started(0, [...marina, "--drain-s", "4", "--drain-to", `ws://127.0.0.1:${other.port}`]);
    const water = await connected(first.url);
    const told = [water.once("draining"), water.once("moved"), water.once("connected")];
    const ended = first.stop("SIGTERM");
    expect((await told[0]).goTo).toBe(`ws://127.0.0.1:${other.port}`);
    expect((await told[1]).url).toBe(`ws://127.0.0.1:${other.port}/ws`);
    await told[2];
    await ended;
    expect((await water.splash({})).appliedTick).toBeGreaterThan(0);
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
  });

  it("says in one sentence that the server speaks another major version", async () => {
    const fake = await fakeServer({ version: { major: 2, minor: 0 } });
    const error = await failure(connected(fake.url));
    expect(error).toMatchObject({ name: "Refused" });
    expect(error.message).toMatch(/^the server speaks version 2\.0 of the wire, this client 1\.\d+; reload the page, or update the client$/);
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
  });
});

describe("frames of every kept version of the wire", () => {
  const cases = JSON.parse(readFileSync(join(kGolden, "golden.json"), "utf8"));
  const layerOf = (golden) => golden.layer.replace("LAYER_", "").toLowerCase();
  const chain = (golden) => (golden.follows ? [...chain(cases.find(({ file }) => file === golden.follows)), golden] : [golden]);
  let fake;
  /** Messages that the server sends when the client subscribes. */
  let messages;
  beforeEach(async () => {
    fake = await fakeServer({ answer: (message, socket) => message.case === "subscribe" && messages.forEach((bytes) => socket.send(bytes)) });
  });

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
