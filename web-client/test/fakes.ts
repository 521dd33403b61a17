// A world under the test's hand: sockets that only it opens and closes, a clock that only it moves.
import { fromBinary } from "@bufbuild/protobuf";

import { ClientMessageSchema, type ClientMessage } from "../src/gen/spindrift/v1/wire_pb";
import { Connection, type ConnectionEvents, type ConnectionWorld, type SocketLike } from "../src/net/connection";
import type { ConnectionState } from "../src/net/messages";
import { encode, type ServerBody } from "./wire";

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

/** Timers and time in one: advance() runs what falls due, in order. */
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
  readonly states: ConnectionState[] = [];
  readonly log: [string, ...unknown[]][] = [];
  readonly connection: Connection;
  /** The clock moves on by this once it has been looked at: a device that takes its time with the next message. */
  slowReadMs = 0;

  constructor(random = 0.5) {
    const world: ConnectionWorld = {
      openSocket: (url, subprotocol) => {
        const socket = new FakeSocket(url, subprotocol);
        this.sockets.push(socket);
        return socket;
      },
      nowMs: () => {
        const { nowMs } = this.time;
        this.time.nowMs += this.slowReadMs;
        this.slowReadMs = 0;
        return nowMs;
      },
      random: () => random,
      setTimer: (callback, ms) => this.time.setTimer(callback, ms),
      clearTimer: (timer) => this.time.clearTimer(timer),
    };
    const note = (name: string) => (...args: unknown[]) => void this.log.push([name, ...args]);
    const events: ConnectionEvents = {
      state: (state) => this.states.push(state),
      greeting: note("greeting"), frame: note("frame"), diagnostics: note("diagnostics"), ack: note("ack"), reject: note("reject"),
      parameterChanged: note("parameterChanged"), roomState: note("roomState"), boatList: note("boatList"),
      roomEvent: note("roomEvent"), welcome: note("welcome"), people: note("people"), clock: note("clock"), stats: note("stats"),
    };
    this.connection = new Connection("ws://host/ws", world, events);
    this.connection.start();
  }

  get socket(): FakeSocket {
    return this.sockets.at(-1)!;
  }

  get state(): ConnectionState {
    return this.states.at(-1)!;
  }

  logOf(name: string): unknown[][] {
    return this.log.filter(([logged]) => logged === name).map(([, ...args]) => args);
  }

  lastStats(): Record<string, unknown> {
    return this.logOf("stats").at(-1)![0] as Record<string, unknown>;
  }
}

