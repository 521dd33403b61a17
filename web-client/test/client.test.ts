// The pieces of the package spindrift-client that need no server; tests/wire/javascript_client.test.mjs uses the whole.
import { describe, expect, it } from "vitest";

import { parseAddress, restBase } from "../client/water/address";
import { checkFields, kCommandNames, offence } from "../client/water/commands";
import { FrameStream } from "../client/water/frame_stream";
import { LayerInbox } from "../client/water/layer_inbox";

describe("addresses", () => {
  it.each([
    ["localhost:8080", "ws://localhost:8080/ws"],
    ["http://h:8080/", "ws://h:8080/ws"],
    ["https://h", "wss://h/ws"],
    ["wss://h/ws/pool", "wss://h/ws/pool"],
    ["https://h/water/?room=big%20pool", "wss://h/water/ws/big%20pool"],
    ["http://h/a/index.html", "ws://h/a/ws"],
    ["http://[::1]:9000/?quality=low", "ws://[::1]:9000/ws"],
  ])("reads %s", (text, socket) => {
    expect(parseAddress(text)).toEqual({ socket, token: "" });
  });

  it("puts options before what the address says, and takes the token of a link", () => {
    expect(parseAddress("http://h/?room=a#token=t")).toEqual({ socket: "ws://h/ws/a", token: "t" });
    expect(parseAddress("http://h/?room=a#token=t", "b", "u")).toEqual({ socket: "ws://h/ws/b", token: "u" });
  });

  it.each(["ftp://h", "", "http://", "h h"])("refuses %j with an example", (text) => {
    expect(() => parseAddress(text)).toThrow(/which looks like http:\/\/host:8080/);
  });

  it("lead to the requests of the same server", () => {
    expect(restBase("ws://h:1/ws")).toBe("http://h:1/");
    expect(restBase("wss://h/water/ws/big%20pool")).toBe("https://h/water/");
  });
});

describe("fields of commands", () => {
  it("are those of the wire, in inner messages and lists too", () => {
    expect(kCommandNames).toContain("removeGauge");
    // Nobody would get its answer.
    expect(() => checkFields("query", {})).toThrow(/^there is no command "query"/);
    expect(() => checkFields("spawnBoat", { boat: { xM: 1 } })).not.toThrow();
    expect(() => checkFields("spawnBoat", { boat: { x: 1 } })).toThrow(/^spawnBoat\.boat has no "x"; it has .*xM/);
    expect(() => checkFields("stroke", { points: [{ xM: 0 }, { xM: true }] })).toThrow(/^stroke\.points\[1\]\.xM takes a number, not true$/);
    expect(() => checkFields("stroke", { points: {} })).toThrow(/takes an array/);
    for (const seed of [5, 5n]) expect(() => checkFields("reset", { seed })).not.toThrow();
    expect(() => checkFields("reset", { seed: "5" })).toThrow(/^reset\.seed takes a number, not 5$/);
    expect(() => checkFields("controlBoat", { boatId: 5n })).toThrow(/takes a number/);
    expect(() => checkFields("reset", null)).toThrow(/takes an object/);
  });

  it("are found by the names that a reject has", () => {
    const none = new Map();
    expect(offence({ case: "splash", value: { depthM: 99 } }, "splash.depth_m", none)).toMatchObject({ value: 99, bound: { unit: "m" } });
    expect(offence({ case: "splash", value: {} }, "", none)).toEqual({ value: undefined, bound: undefined });
    expect(offence({ case: "splash", value: {} }, "splash.no_such", none)).toEqual({ value: undefined, bound: undefined });
    expect(offence({ case: "controlBoat", value: { boatId: 9 } }, "control_boat.boat_id", none)).toEqual({ value: 9, bound: undefined });
  });
});

describe("queues of frames", () => {
  it("keep the newest, give them in order and count the others", async () => {
    const stream = new FrameStream<number>(2, () => {});
    for (let k = 1; k <= 5; ++k) stream.put(k);
    expect([stream.dropped, stream.waitingCount]).toEqual([3, 2]);
    expect([(await stream.next()).value, (await stream.next()).value]).toEqual([4, 5]);
    const waiting = stream.next();
    stream.put(6);
    expect((await waiting).value).toBe(6);
    stream.put(7);
    stream.finish(new Error("over"));
    expect((await stream.next()).value).toBe(7);
    await expect(stream.next()).rejects.toThrow("over");
  });

  it("bound their capacity and their readers", async () => {
    for (const capacity of [0, 1.5, Infinity, NaN]) expect(() => new FrameStream(capacity, () => {})).toThrow(RangeError);
    const stream = new FrameStream<number>(1, () => {});
    const readers = Array.from({ length: 64 }, () => stream.next());
    await expect(stream.next()).rejects.toThrow("64 calls");
    stream.finish();
    expect(await Promise.all(readers)).toEqual(readers.map(() => ({ done: true, value: undefined })));
  });

  it("are one for each loop, beside the newest frame", async () => {
    const inbox = new LayerInbox<number>();
    const [a, b] = [inbox.stream(2), inbox.stream(1)];
    for (let k = 1; k <= 3; ++k) inbox.put(k);
    expect(inbox.dropped).toBe(3);
    expect([(await a.next()).value, (await b.next()).value, await inbox.next()]).toEqual([2, 3, 3]);
    await b.return();
    inbox.put(4);
    expect([inbox.dropped, b.waitingCount, await inbox.next()]).toEqual([3, 0, 4]);
  });
});
