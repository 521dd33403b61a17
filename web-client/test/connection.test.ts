import { describe, expect, it } from "vitest";

import { kWireMinor } from "../client/codec/greeting";
import { Layer, RejectReason, RoomEventKind } from "../client/gen/spindrift/v1/wire_pb";
import { backoffS } from "../client/session/backoff";
import type { LocalReason } from "../client/session/events";
import { socketUrl } from "../src/net/water_client";
import { Rig } from "./fakes";
import { encode, foamFrame, greeting, surfaceFrame } from "./wire";

/** The reject that the connection makes itself. */
function notDone(commandId: bigint, reason: LocalReason, why: string) {
  return { commandId, reason, field: "", message: expect.stringContaining(why) };
}

const splash = { case: "splash" as const, value: { xM: 1, zM: 2, radiusM: 1, depthM: 0.5 } };

describe("the connection", () => {
  it("says hello first and subscribes to the offered layers after the greeting", () => {
    const rig = new Rig();
    expect(rig.socket).toMatchObject({ url: "ws://host/ws", subprotocol: "spindrift.v1", binaryType: "arraybuffer" });
    expect(rig.state.name).toBe("connecting");
    rig.socket.open();
    expect(rig.socket.sent).toHaveLength(1);
    expect(rig.socket.sent[0]).toMatchObject({ case: "hello", value: { version: { major: 1, minor: kWireMinor } } });
    expect(rig.socket.sent[0]?.value).toMatchObject({ client: expect.stringMatching(/^spindrift-web \d+\.\d+\.\d+$/) });
    rig.socket.deliver(greeting());
    expect(rig.state.name).toBe("live");
    expect(rig.socket.sentOf("subscribe").map(({ value }) => [value.layer, value.maxRateHz])).toEqual([
      [Layer.SURFACE, 30], [Layer.PARTICLES, 30], [Layer.DIAGNOSTICS, 10],
    ]);
  });

  it("subscribes to no layer that the room does not offer", () => {
    const rig = new Rig();
    rig.socket.open();
    rig.socket.deliver(greeting({ layers: [Layer.PARTICLES, 77 as Layer] }));
    expect(rig.socket.sentOf("subscribe").map(({ value }) => value.layer)).toEqual([Layer.PARTICLES]);
  });

  it("subscribes to foam, bodies and floaters at the frame rate where the room offers them", () => {
    const rig = new Rig();
    rig.socket.open();
    rig.socket.deliver(greeting({ layers: [Layer.FOAM, Layer.FLOATERS, Layer.BODIES, Layer.SURFACE] }));
    expect(rig.socket.sentOf("subscribe").map(({ value }) => [value.layer, value.maxRateHz])).toEqual([
      [Layer.SURFACE, 30], [Layer.FOAM, 30], [Layer.BODIES, 30], [Layer.FLOATERS, 30],
    ]);
  });

  it("forwards boats, room events and the id of a new boat", () => {
    const rig = Rig.live();
    const boat = { boatId: 3, lengthM: 2.4, beamM: 0.9, heightM: 0.6, draughtM: 0.24 };
    rig.socket.deliver({ case: "boatList", value: { boats: [boat] } });
    rig.socket.deliver({ case: "roomEvent", value: { kind: RoomEventKind.RECOVERED, tick: 4n, message: "the water was put back" } });
    rig.connection.command(1, { case: "spawnBoat", value: {} });
    rig.socket.deliver({ case: "ack", value: { commandId: 1n, appliedTick: 5n, boatId: 3 } });
    expect(rig.eventsOf("boatList")).toEqual([{ kind: "boatList", boats: [boat] }]);
    expect(rig.eventsOf("roomEvent")).toEqual([{ kind: "roomEvent", event: "recovered", tick: 4n, personId: 0, message: "the water was put back" }]);
    expect(rig.eventsOf("ack")).toEqual([{ kind: "ack", commandId: 1n, appliedTick: 5n, boatId: 3, floaterId: 0, gaugeId: 0 }]);
  });

  it("counts the layers of one tick as one frame, in any order", () => {
    const rig = Rig.live();
    for (let i = 0; i < 200; ++i) {
      rig.socket.deliver(surfaceFrame([1, 2, 3, 4], { tick: BigInt(2 * i) }));
      if (i > 0) rig.socket.deliver(foamFrame(new Uint8Array(4), { tick: BigInt(2 * i - 2) }));
      rig.time.advance(50);
    }
    expect(rig.lastStats().framesPerS).toBeCloseTo(20, 1);
    expect(rig.lastStats().receivedCount).toMatchObject({ surface: 200, foam: 199, bodies: 0 });
  });

  it("stops after a refusal or another major version until the user retries", () => {
    const rig = new Rig();
    rig.socket.open();
    rig.socket.deliver({ case: "refusal", value: { message: "unknown layer 9" } });
    expect(rig.state).toEqual({ name: "refused", reason: "unknown layer 9", rooms: [] });
    expect(rig.socket.closed).toBe(true);
    rig.time.advance(60_000);
    expect(rig.sockets).toHaveLength(1);
    rig.connection.retryNow();
    rig.socket.open();
    rig.socket.deliver(greeting({ version: { major: 2, minor: 0 } }));
    expect(rig.state).toMatchObject({ name: "refused", reason: expect.stringContaining("version 2.0") });
  });

  it("reconnects after waits that double up to eight seconds", () => {
    const rig = new Rig();
    const waits: number[] = [];
    for (let i = 0; i < 7; ++i) {
      rig.socket.drop();
      if (rig.state.name !== "retrying") throw new Error(rig.state.name);
      waits.push(rig.state.inS);
      const sockets = rig.sockets.length;
      rig.time.advance(rig.state.inS * 1000 - 1);
      expect(rig.sockets).toHaveLength(sockets);
      rig.time.advance(1);
      expect(rig.sockets).toHaveLength(sockets + 1);
    }
    expect(waits).toEqual([0.5, 1, 2, 4, 8, 8, 8]);
  });

  it("starts with the shortest wait again only after a connection of five seconds", () => {
    const rig = new Rig();
    for (let i = 0; i < 3; ++i) {
      rig.greet();
      rig.time.advance(100);
      rig.socket.drop();
      if (rig.state.name === "retrying") rig.time.advance(rig.state.inS * 1000);
    }
    rig.greet();
    rig.time.advance(5000);
    rig.socket.drop(1001, "the server ends");
    expect(rig.state).toEqual({ name: "retrying", inS: 0.5, why: "the server ends" });
  });

  it("spreads the waits at random within their bounds", () => {
    for (let attempt = 1; attempt < 40; ++attempt)
      for (const random of [0, 0.3, 0.999]) {
        const s = backoffS(attempt, random);
        expect(s).toBeGreaterThanOrEqual(0.5);
        expect(s).toBeLessThanOrEqual(8);
      }
    expect(backoffS(3, 0)).toBeLessThan(backoffS(3, 0.999));
  });

  it("treats a silent server as lost", () => {
    const rig = Rig.live();
    rig.time.advance(9_000);
    rig.socket.deliver({ case: "pong", value: { clientTimeS: rig.time.nowMs / 1000, serverTimeS: 0 } });
    rig.time.advance(9_000);
    expect(rig.state.name).toBe("live");
    rig.time.advance(2_000);
    expect(rig.states.at(-2)).toMatchObject({ name: "retrying", why: expect.stringContaining("no message") });
    expect(rig.sockets).toHaveLength(2);
  });

  it("treats a server without a greeting as lost", () => {
    const rig = new Rig();
    rig.socket.open();
    rig.time.advance(11_000);
    expect(rig.states.some((state) => state.name === "retrying")).toBe(true);
  });

  it("pings every two seconds after five early pings", () => {
    const rig = Rig.live();
    const sentAtMs: number[] = [];
    for (let i = 0; i < 24; ++i) {
      rig.time.advance(250);
      rig.socket.deliver({ case: "roomState", value: { paused: false, speed: 1 } });
    }
    for (const { value } of rig.socket.sentOf("ping")) sentAtMs.push(value.clientTimeS * 1000);
    expect(sentAtMs).toEqual([1000, 1500, 2000, 2500, 3000, 5000, 7000]);
  });

  it("reports the shortest round trip of the last five", () => {
    const rig = Rig.live();
    for (const roundTripMs of [12, 80, 33, 250, 90, 60]) {
      rig.time.advance(500);
      rig.socket.deliver({ case: "pong", value: { clientTimeS: (rig.time.nowMs - roundTripMs) / 1000, serverTimeS: 0 } });
    }
    rig.time.advance(500);
    expect(rig.lastStats().latencyMs).toBeCloseTo(33, 6);
  });

  it("matches answers to commands and forwards each answer once", () => {
    const rig = Rig.live();
    rig.connection.command(1, splash);
    rig.connection.command(2, { case: "reset", value: {} });
    expect(rig.socket.sentOf("command").map(({ value }) => [value.commandId, value.action.case])).toEqual([[1n, "splash"], [2n, "reset"]]);
    rig.socket.deliver({ case: "reject", value: { commandId: 2n, reason: RejectReason.BUSY, field: "", message: "try again" } });
    rig.socket.deliver({ case: "ack", value: { commandId: 1n, appliedTick: 77n } });
    rig.socket.deliver({ case: "ack", value: { commandId: 1n, appliedTick: 78n } });
    expect(rig.eventsOf("ack")).toEqual([{ kind: "ack", commandId: 1n, appliedTick: 77n, boatId: 0, floaterId: 0, gaugeId: 0 }]);
    expect(rig.eventsOf("reject")).toEqual([{ kind: "reject", commandId: 2n, reason: "BUSY", field: "", message: "try again" }]);
  });

  it("rejects a command that cannot be sent, is lost or stays unanswered", () => {
    const rig = new Rig();
    rig.connection.command(1, splash);
    expect(rig.eventsOf("reject").at(-1)).toMatchObject(notDone(1n, "NOT_SENT", "not connected"));
    rig.greet();
    rig.connection.command(2, splash);
    rig.socket.drop();
    expect(rig.eventsOf("reject").at(-1)).toMatchObject(notDone(2n, "LOST", "lost"));
    rig.time.advance(500);
    rig.greet();
    rig.connection.command(3, splash);
    for (let i = 0; i < 22; ++i) {
      rig.time.advance(500);
      rig.socket.deliver({ case: "roomState", value: { paused: false, speed: 1 } });
    }
    expect(rig.eventsOf("reject").at(-1)).toMatchObject(notDone(3n, "NO_ANSWER", "no answer"));
  });

  it("waits without a limit for commands that build water", () => {
    const rig = Rig.live();
    rig.connection.command(1, { case: "changeScene", value: { name: "harbor" } });
    rig.connection.command(2, { case: "setParameter", value: { path: "particles.count", value: 1e5 } });
    for (let i = 0; i < 240; ++i) {
      rig.time.advance(500);
      rig.socket.deliver({ case: "roomState", value: { paused: false, speed: 1 } });
    }
    expect(rig.eventsOf("reject")).toEqual([]);
    rig.socket.deliver({ case: "ack", value: { commandId: 1n, appliedTick: 9n } });
    expect(rig.eventsOf("ack")).toMatchObject([{ commandId: 1n }]);
    rig.socket.drop();
    expect(rig.eventsOf("reject")).toMatchObject([notDone(2n, "LOST", "lost")]);
  });

  it("holds at most 64 unanswered commands, and sends none into a congested socket", () => {
    const rig = Rig.live();
    for (let id = 1; id <= 65; ++id) rig.connection.command(id, splash);
    expect(rig.socket.sentOf("command")).toHaveLength(64);
    expect(rig.eventsOf("reject")).toMatchObject([notDone(65n, "NOT_SENT", "waiting")]);
    rig.socket.deliver({ case: "ack", value: { commandId: 1n, appliedTick: 1n } });
    rig.socket.bufferedAmount = 1 << 20;
    rig.connection.command(66, splash);
    expect(rig.eventsOf("reject").at(-1)).toMatchObject(notDone(66n, "NOT_SENT", "congested"));
  });

  it("counts malformed messages and continues", () => {
    const rig = Rig.live();
    rig.socket.onmessage!({ data: "text" });
    rig.socket.onmessage!({ data: Uint8Array.of(0x12, 0xff).buffer });
    rig.socket.deliver(surfaceFrame([1, 2, 3, 4], { crc32c: 9 }));
    rig.socket.deliver(surfaceFrame([1, 2, 3, 4]));
    rig.time.advance(500);
    expect(rig.lastStats()).toMatchObject({ malformedCount: 3, receivedCount: { surface: 1, particles: 0, diagnostics: 0 } });
    expect(rig.frames).toHaveLength(1);
    expect(rig.state.name).toBe("live");
  });

  it("measures bytes and frames per second", () => {
    const rig = Rig.live();
    const bytesCount = encode(surfaceFrame(new Array<number>(400).fill(1))).byteLength;
    for (let i = 0; i < 200; ++i) {
      rig.socket.deliver(surfaceFrame(new Array<number>(400).fill(1), { tick: BigInt(i) }));
      rig.time.advance(50);
    }
    expect(rig.lastStats().framesPerS).toBeCloseTo(20, 1);
    expect(rig.lastStats().kilobytesPerS).toBeCloseTo((20 * bytesCount) / 1000, 1);
  });

  it("subscribes to no frames while the page is hidden", () => {
    const rig = Rig.live();
    rig.page.want({ visible: false });
    expect(rig.socket.sentOf("subscribe").slice(3).map(({ value }) => [value.layer, value.maxRateHz])).toEqual([
      [Layer.SURFACE, 0], [Layer.PARTICLES, 0], [Layer.DIAGNOSTICS, 10],
    ]);
    rig.page.want({ visible: true });
    expect(rig.socket.sentOf("subscribe").slice(6).map(({ value }) => value.maxRateHz)).toEqual([30, 30, 10]);
  });

  it("leaves no timer and no handler behind when stopped", () => {
    const rig = Rig.live();
    rig.connection.stop();
    expect(rig.time.timerCount).toBe(0);
    expect(rig.socket).toMatchObject({ closed: true, onmessage: null, onclose: null });
  });
});

describe("socketUrl", () => {
  it("takes the room from the address and the scheme from the page", () => {
    expect(socketUrl("http://h:8080/")).toBe("ws://h:8080/ws");
    expect(socketUrl("https://h/?quality=low&room=big%20pool#x")).toBe("wss://h/ws/big%20pool");
  });

  it("is beside the page, whatever path a proxy has given it", () => {
    expect(socketUrl("https://h/water/?room=pool")).toBe("wss://h/water/ws/pool");
    expect(socketUrl("http://h/a/b/index.html")).toBe("ws://h/a/b/ws");
  });
});
