// Sockets and a clock that the test controls.
import { fromBinary } from "@bufbuild/protobuf";

import type { PlainFrame } from "../client/codec/frame_types";
import { ClientMessageSchema, type ClientMessage } from "../client/gen/spindrift/v1/wire_pb";
import type { Connection } from "../client/session/connection";
import { PageConnection } from "../src/net/page_connection";
import type { ConnectionSink, ConnectionWorld, SocketLike } from "../client/session/world";
import type { ConnectionState } from "../client/session/events";
import type { PageConnectionEvent, LinkStats } from "../src/net/messages";
import type { MissingRoom } from "../client/session/missing_room";
import { encode, greeting, type ServerBody } from "./wire";

export class FakeSocket implements SocketLike {
  binaryType = "blob";
  bufferedAmount = 0;
  onopen: SocketLike["onopen"] = null;
  onmessage: SocketLike["onmessage"] = null;
  onclose: SocketLike["onclose"] = null;
  onerror: SocketLike["onerror"] = null;
  closed = false;
  readonly sent: ClientMessage["message"][] = [];

  constructor(
    readonly url: string,
    readonly subprotocol: string,
  ) {}

  send(bytes: Uint8Array): void {
    this.sent.push(fromBinary(ClientMessageSchema, bytes).message);
  }

  close(): void {
    this.closed = true;
  }

  open(): void {
    this.onopen?.({} as never);
  }

  deliver(body: ServerBody): void {
    this.onmessage?.({ data: encode(body) });
  }

  drop(code = 1006, reason = ""): void {
    this.onclose?.({ code, reason });
  }

  sentOf<K extends ClientMessage["message"]["case"]>(kind: K): Extract<ClientMessage["message"], { case: K }>[] {
    return this.sent.filter((message) => message.case === kind) as Extract<ClientMessage["message"], { case: K }>[];
  }
}

/** Clock and timers: advance() runs the timers that fall due, in order. */
export class FakeTime {
  nowMs = 1000;
  private nextId = 1;
  private readonly timers = new Map<number, { atMs: number; callback: () => void }>();

  setTimer(callback: () => void, ms: number): number {
    this.timers.set(this.nextId, { atMs: this.nowMs + ms, callback });
    return this.nextId++;
  }

  clearTimer(timer: number): void {
    this.timers.delete(timer);
  }

  get timerCount(): number {
    return this.timers.size;
  }

  advance(ms: number): void {
    const endMs = this.nowMs + ms;
    for (;;) {
      const due = [...this.timers].filter(([, t]) => t.atMs <= endMs).sort(([, a], [, b]) => a.atMs - b.atMs)[0];
      if (!due) break;
      this.timers.delete(due[0]);
      this.nowMs = due[1].atMs;
      due[1].callback();
    }
    this.nowMs = endMs;
  }
}

export class Rig {
  readonly time = new FakeTime();
  readonly sockets: FakeSocket[] = [];
  readonly events: PageConnectionEvent[] = [];
  readonly frames: PlainFrame[] = [];
  readonly page: PageConnection;
  readonly connection: Connection;
  /** What REST says about the room, and how often it was asked. */
  missing: MissingRoom | undefined;
  askedCount = 0;
  /** Answers the wish to open the room; undefined: the page's address has no scene. */
  whyNotOpened: (() => Promise<string | undefined>) | undefined;
  /** Time that the next message takes to read: the clock advances by this after it is next read. */
  slowReadMs = 0;

  constructor(random = 0.5) {
    const world: ConnectionWorld = {
      openSocket: (url, subprotocol) => {
        const socket = new FakeSocket(url, subprotocol);
        this.sockets.push(socket);
        return socket;
      },
      findMissingRoom: () => {
        ++this.askedCount;
        return Promise.resolve(this.missing);
      },
      nowMs: () => {
        const { nowMs } = this.time;
        this.time.nowMs += this.slowReadMs;
        this.slowReadMs = 0;
        return nowMs;
      },
      random: () => random,
      setTimer: (callback, ms) => this.time.setTimer(callback, ms),
      clearTimer: (timer) => this.time.clearTimer(timer as number),
    };
    Object.defineProperty(world, "openRoom", { get: () => this.whyNotOpened });
    const sink: ConnectionSink<PageConnectionEvent> = {
      event: (event) => this.events.push(event),
      frame: (frame) => this.frames.push(frame),
    };
    this.page = new PageConnection("ws://host/ws", world, sink);
    this.connection = this.page.session;
    this.connection.start();
  }

  /** A connection that has been greeted. */
  static live(): Rig {
    const rig = new Rig();
    rig.greet();
    return rig;
  }

  /** The socket opens, and the server greets. */
  greet(): void {
    this.socket.open();
    this.socket.deliver(greeting());
  }

  /** Loses the connection and gets another one. */
  reconnect(): void {
    this.socket.drop();
    this.time.advance(1000);
    this.greet();
  }

  get socket(): FakeSocket {
    return this.sockets.at(-1)!;
  }

  get states(): ConnectionState[] {
    return this.eventsOf("state").map(({ state }) => state);
  }

  get state(): ConnectionState {
    return this.states.at(-1)!;
  }

  eventsOf<K extends PageConnectionEvent["kind"]>(kind: K): Extract<PageConnectionEvent, { kind: K }>[] {
    return this.events.filter((event) => event.kind === kind) as Extract<PageConnectionEvent, { kind: K }>[];
  }

  lastStats(): LinkStats {
    return this.eventsOf("stats").at(-1)!.stats;
  }
}

/** A clock and timers that the test moves. */
export class World {
  ms = 0;
  private timers: { atMs: number; callback: () => void }[] = [];
  nowMs = (): number => this.ms;
  setTimer = (callback: () => void, ms: number): number => this.timers.push({ atMs: this.ms + ms, callback });
  clearTimer = (): void => {};
  pass(ms: number): void {
    const endMs = this.ms + ms;
    for (;;) {
      const next = this.timers.filter(({ atMs }) => atMs <= endMs).sort((a, b) => a.atMs - b.atMs)[0];
      if (!next) break;
      this.timers.splice(this.timers.indexOf(next), 1);
      this.ms = next.atMs;
      next.callback();
    }
    this.ms = endMs;
  }
}
