// What a program does with a room besides frames: points, clocks, moved boats; over sockets that the test controls.
import { describe, expect, it } from "vitest";

import type { SocketLike } from "../client/session/world";
import { ConnectionLost, NoAnswer, Rejected, SpindriftError } from "../client/water/errors";
import { Water } from "../client/water/water";
import { RejectReason } from "../client/gen/spindrift/v1/wire_pb";
import { FakeSocket, FakeTime } from "./fakes";
import { greeting, type ServerBody } from "./wire";

class Room {
  readonly time = new FakeTime();
  readonly sockets: FakeSocket[] = [];
  readonly water: Water;

  constructor(answerWithinS = 10) {
    const settings = { socketUrl: "ws://host/ws", name: "", token: "", resumeKey: "", client: "test", answerWithinS };
    const openSocket = (url: string, subprotocol: string): SocketLike => {
      const socket = new FakeSocket(url, subprotocol);
      this.sockets.push(socket);
      return socket;
    };
    this.water = new Water(settings, {
      openSocket, findMissingRoom: () => Promise.resolve(undefined), nowMs: () => this.time.nowMs, random: () => 0.5,
      setTimer: (callback, ms) => this.time.setTimer(callback, ms), clearTimer: (timer) => this.time.clearTimer(timer as number),
    });
  }

  static async live(answerWithinS?: number): Promise<Room> {
    const room = new Room(answerWithinS);
    const opened = room.water.open(60);
    room.welcome();
    await opened;
    return room;
  }

  welcome(): void {
    this.socket.open();
    this.socket.deliver(greeting());
    this.deliver({ case: "welcome", value: { personId: 7, resumeKey: "key" } });
  }

  get socket(): FakeSocket {
    return this.sockets.at(-1)!;
  }

  deliver(body: ServerBody): void {
    this.socket.deliver(body);
  }

  /** The newest command of a kind, which must have been sent. */
  sent<K extends string>(kind: K) {
    const found = this.socket.sentOf("command").map(({ value }) => value).filter(({ action }) => action.case === kind).at(-1);
    expect(found, `a command ${kind}`).toBeDefined();
    return { commandId: found!.commandId, fields: found!.action.value as unknown as Record<string, unknown> };
  }

  ack(kind: string, more: object = {}): Record<string, unknown> {
    const { commandId, fields } = this.sent(kind);
    this.deliver({ case: "ack", value: { commandId, appliedTick: 5n, ...more } });
    return fields;
  }

  answer(queryId: number, tick: number, heights: number[], more: object = {}): void {
    const values = Object.fromEntries(["elevationM", "verticalSpeedMps", "velocityXMps", "velocityZMps", "slopeX", "slopeZ", "depthM", "wetRatio", "foamRatio"].map((name) => [name, heights]));
    this.deliver({ case: "queryAnswer", value: { tick: BigInt(tick), timeS: tick / 60, stateId: 9n, results: [{ queryId, ...values, ...more }] } });
  }
}

const failure = (promise: Promise<unknown>): Promise<unknown> => promise.then(() => expect.fail("resolved"), (error: unknown) => error);

describe("a query", () => {
  it("asks once for points and gives arrays", async () => {
    const room = await Room.live();
    const asked = room.water.query([[1, 2], [900, 0]]);
    const { queryId, xM, zM, intervalTicks, velocityXMps } = room.sent("query").fields as { queryId: number; xM: number[]; zM: number[]; intervalTicks: number; velocityXMps: number[] };
    expect([xM, zM, intervalTicks, velocityXMps]).toEqual([[1, 900], [2, 0], 0, []]);
    room.ack("query");
    room.answer(queryId + 1, 4, [8, 8]);
    room.answer(queryId, 5, [0.5, 0], { outside: [1], last: true });
    const answer = await asked;
    expect(answer).toMatchObject({ tick: 5, timeS: 5 / 60, stateId: 9, elevationM: Float32Array.of(0.5, 0), slopeZ: Float32Array.of(0.5, 0), outside: Uint8Array.of(0, 1) });
    expect(Object.keys(answer).sort()).toEqual(["depthM", "elevationM", "foamRatio", "outside", "slopeX", "slopeZ", "stateId", "tick", "timeS", "velocityXMps", "velocityZMps", "verticalSpeedMps", "wetRatio"]);
    const flat = room.water.query(Float32Array.of(3, 4));
    expect(room.sent("query").fields).toMatchObject({ xM: [3], zM: [4], queryId: queryId + 1 });
    room.water.close();
    expect(await failure(flat)).toBeInstanceOf(ConnectionLost);
  });

  it("is rejected by the server, without an answer, and for anything but points", async () => {
    const room = await Room.live(0.05);
    const bad = room.water.query([[NaN, 0]]);
    const { commandId } = room.sent("query");
    room.deliver({ case: "reject", value: { commandId, reason: RejectReason.NOT_FINITE, field: "query.x_m[0]", message: "nan is not a finite number" } });
    expect(await failure(bad)).toMatchObject({ name: "Rejected", reason: "NOT_FINITE", value: NaN });
    const late = failure(room.water.query([[0, 0]]));
    room.ack("query");
    expect(await late).toBeInstanceOf(NoAnswer);
    expect(await failure(room.water.query([]))).toBeInstanceOf(RangeError);
    expect(await failure(room.water.query([[1]] as never))).toBeInstanceOf(TypeError);
    expect(await failure(room.water.query(Float32Array.of(1, 2, 3)))).toBeInstanceOf(TypeError);
    expect(() => room.water.streamQuery([[0, 0]], { velocities: [[1, 1], [2, 2]] })).toThrow(RangeError);
    expect(() => room.water.streamQuery([[0, 0]], { intervalTicks: 0.5 })).toThrow(RangeError);
    expect(() => room.water.streamQuery([[0, 0]], { capacity: 1e6 })).toThrow(RangeError);
    expect(room.water.damagedCount).toBe(0);
  });

  it("streams answers, drops the oldest and counts them, and ends when its loop is left", async () => {
    const room = await Room.live();
    const stream = room.water.streamQuery([[0, 0]], { velocities: [[1, 0]], intervalTicks: 3, capacity: 4 });
    const { queryId } = room.ack("query") as { queryId: number };
    expect(room.sent("query").fields).toMatchObject({ intervalTicks: 3, velocityXMps: [1], velocityZMps: [0] });
    for (let tick = 1; tick <= 50; ++tick) room.answer(queryId, tick, [tick]);
    expect([stream.waitingCount, stream.dropped]).toEqual([4, 46]);
    const ticks = [];
    for await (const { tick } of stream) if (ticks.push(tick) === 2) break;
    expect(ticks).toEqual([47, 48]);
    expect(room.sent("query").fields).toMatchObject({ queryId, xM: [], zM: [] });
    room.answer(queryId, 51, [1]);
    expect(stream.waitingCount).toBe(0);
  });

  it("ends with an error with another scene and with the connection, and can be asked again", async () => {
    const room = await Room.live();
    const scene = room.water.streamQuery([[0, 0]]);
    const { queryId } = room.ack("query") as { queryId: number };
    room.answer(queryId, 1, [0.5]);
    room.answer(queryId, 2, [], { ended: "the scene has changed", last: true });
    expect((await scene.next()).value).toMatchObject({ tick: 1 });
    expect(await failure(scene.next())).toMatchObject({ name: "SpindriftError", message: "the query has ended: the scene has changed" });
    const cut = room.water.streamQuery([[0, 0]]);
    room.ack("query");
    const waiting = failure(cut.next());
    const unanswered = failure(room.water.query([[1, 1]]));
    room.socket.drop();
    expect(await waiting).toBeInstanceOf(ConnectionLost);
    expect(await unanswered).toBeInstanceOf(ConnectionLost);
    expect(await failure(room.water.streamQuery([[0, 0]]).next())).toMatchObject({ name: "ConnectionLost", wasSent: false });
    room.time.advance(2000);
    room.welcome();
    const again = room.water.streamQuery([[0, 0]]);
    const { queryId: next } = room.ack("query") as { queryId: number };
    room.answer(next, 7, [0.25]);
    expect((await again.next()).value).toMatchObject({ tick: 7 });
    room.answer(next, 8, [0.25], { slopeX: [1, 2] });
    room.time.advance(600);
    expect(room.water.damagedCount).toBe(1);
  });
});

describe("a clock", () => {
  it("is held until it is released, and its steps are resolved when they are done", async () => {
    const room = await Room.live();
    const taking = room.water.takeClock({ timeoutS: 3 });
    expect(room.ack("takeClock")).toMatchObject({ timeoutS: 3 });
    const clock = await taking;
    room.deliver({ case: "roomState", value: { speed: 1, clockPersonIds: [7] } });
    expect(room.water.clockPersonIds).toEqual([7]);
    const [step, other] = [clock.step(60), failure(room.water.splash())];
    for (let seconds = 0; seconds < 60; seconds += 5) {
      room.time.advance(5000);
      room.deliver({ case: "pong", value: {} });
    }
    expect(await other).toBeInstanceOf(NoAnswer);
    expect(room.ack("step", { appliedTick: 65n, stateHash: 9n })).toMatchObject({ tickCount: 60, waits: true });
    expect(await step).toMatchObject({ appliedTick: 65, stateHash: 9n });
  });

  it("gives the hash of the state, splits long steps, and ends without an error when it was lost", async () => {
    const room = await Room.live();
    const taking = room.water.takeClock();
    room.ack("takeClock");
    const clock = await taking;
    const long = clock.step(601);
    expect(room.ack("step", { appliedTick: 600n, stateHash: 1n })).toMatchObject({ tickCount: 600 });
    await Promise.resolve();
    await new Promise((resolve) => setTimeout(resolve));
    expect(room.ack("step", { appliedTick: 601n, stateHash: 2n ** 64n - 1n })).toMatchObject({ tickCount: 1, waits: true });
    expect(await long).toMatchObject({ appliedTick: 601, stateHash: 2n ** 64n - 1n });
    const held = clock.step();
    room.deliver({ case: "reject", value: { commandId: room.sent("step").commandId, reason: RejectReason.CLOCK_HELD, message: "person 8 holds the clock" } });
    expect(await failure(held)).toMatchObject({ name: "Rejected", reason: "CLOCK_HELD" });
    expect(await failure(clock.step(0))).toBeInstanceOf(RangeError);
    const released = clock.release();
    room.deliver({ case: "reject", value: { commandId: room.sent("releaseClock").commandId, reason: RejectReason.NOT_NOW, message: "not held" } });
    await released;
    await clock.release();
    expect(room.socket.sentOf("command").filter(({ value }) => value.action.case === "releaseClock")).toHaveLength(1);
    const refused = room.water.takeClock();
    room.deliver({ case: "reject", value: { commandId: room.sent("takeClock").commandId, reason: RejectReason.FORBIDDEN, message: "for operators" } });
    expect(await failure(refused)).toBeInstanceOf(Rejected);
  });
});

describe("moved boats", () => {
  const forces = (tick: number): ServerBody => ({
    case: "hullForces",
    value: { tick: BigInt(tick), timeS: tick / 60, stateId: BigInt(tick), hulls: [{ boatId: 3, hydrostatic: { forceYN: 100, momentPitchNm: 2 }, drag: { forceXN: -1 } }] },
  });

  it("get their forces: the newest, or all in order, the oldest dropped and counted", async () => {
    const room = await Room.live();
    const moved = room.water.moveBoat({ boatId: 3, xM: 1.5, headingRad: 0.25 });
    expect(room.ack("moveBoat")).toMatchObject({ boatId: 3, xM: 1.5, headingRad: 0.25 });
    await moved;
    const stream = room.water.streamHullForces({ capacity: 2 });
    for (let tick = 1; tick <= 10; ++tick) room.deliver(forces(tick));
    expect(await room.water.hullForces()).toMatchObject({ tick: 10, stateId: 10, hulls: [{ boatId: 3, hydrostatic: { forceYN: 100, momentPitchNm: 2, forceXN: 0 }, dynamic: { forceXN: 0 }, drag: { forceXN: -1 } }] });
    expect([(await stream.next()).value?.tick, (await stream.next()).value?.tick, room.water.dropped.hullForces]).toEqual([9, 10, 8]);
    const waiting = [failure(stream.next()), failure(room.water.hullForces())];
    room.socket.drop();
    for (const error of await Promise.all(waiting)) expect(error).toBeInstanceOf(ConnectionLost);
    expect(room.water.dropped.hullForces).toBe(8);
    room.time.advance(2000);
    room.welcome();
    const next = room.water.hullForces();
    room.deliver(forces(20));
    expect((await next).tick).toBe(20);
    room.water.close();
    expect(await failure(room.water.hullForces())).toBeInstanceOf(SpindriftError);
  });
});

describe("a hundred clients in one process", () => {
  it("keep their bounds, drop and count frames, and lose no command without an error", async () => {
    const rooms = await Promise.all(Array.from({ length: 100 }, () => Room.live()));
    const ends: string[] = [];
    const commands = rooms.flatMap(({ water }) => Array.from({ length: 70 }, () => water.splash({}).then(() => "ack", (error: Error) => error.name).then((end) => ends.push(end))));
    const streams = rooms.map(({ water }) => water.streamHullForces());
    for (const room of rooms) for (let tick = 1; tick <= 60; ++tick) room.deliver({ case: "hullForces", value: { tick: BigInt(tick) } });
    expect(streams.every(({ waitingCount, dropped }) => waitingCount === 16 && dropped === 44)).toBe(true);
    for (const room of rooms) {
      for (const { value } of room.socket.sentOf("command").slice(0, 32)) room.deliver({ case: "ack", value: { commandId: value.commandId, appliedTick: 1n } });
      room.socket.drop();
    }
    await Promise.all(commands);
    expect(["ack", "ConnectionLost", "SpindriftError"].map((end) => ends.filter((each) => each === end).length)).toEqual([3200, 3200, 600]);
    for (const { water } of rooms) water.close();
  });
});
