// One room over one WebSocket at a time: hello, subscriptions, commands with their answers, pings, and coming back
// after a loss. Socket, clock and timers are injected, so tests need no network. Runs in the worker.
import { create, toBinary } from "@bufbuild/protobuf";

import type { ParsedFrame } from "../codec/frames";
import { kLayers, kWireMajor, kWireMinor, type BoatDetail, type GreetingInfo } from "../codec/greeting";
import { kLevels as kWireLevels, lowerLevel, type LevelName } from "../codec/level";
import { PlaneUnpacker } from "../codec/packed_planes";
import { parse, type DiagnosticsInfo, type RoomEventName } from "../codec/parse";
import type { PersonInfo, WelcomeInfo } from "../codec/people";
import { ClientMessageSchema, Packing, type ClientMessage } from "../gen/spindrift/v1/wire_pb";
import { backoffS } from "./backoff";
import { LinkMeter } from "./link_meter";
import { LoadGovernor } from "./load_governor";
import type { CommandAction, ConnectionState, DetailChoice, Identity, LinkStats } from "./messages";
import { ServerClock } from "./server_clock";

export const kSubprotocol = "spindrift.v1";
const kClientName = "spindrift-web 0.1.0";
const kPingEveryMs = 2000;
/** So many come as fast as the housekeeping: until they are back, the server's clock is a guess. */
const kFirstPings = 5;
const kHousekeepingEveryMs = 500;
/** No greeting, or no message at all, for this long: the connection counts as dead. */
const kSilenceMs = 10_000;
const kAnswerPatienceMs = 10_000;
const kMaxPendingCount = 64;
const kMaxUnsentBytes = 256 * 1024;
const kDiagnosticsRateHz = 10;
const kFrameRateHz = 60;
/** A keyframe is asked for at most this often. */
const kKeyframeEveryMs = 1000;
/** Live for this long = a good connection: the next loss starts with the shortest wait again. */
const kSettledMs = 5000;

/** The part of WebSocket that is used. */
export interface SocketLike {
  binaryType: string;
  readonly bufferedAmount: number;
  onopen: ((event: never) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  onerror: ((event: never) => void) | null;
  send(bytes: Uint8Array<ArrayBuffer>): void;
  close(code?: number, reason?: string): void;
}

export interface ConnectionWorld {
  openSocket(url: string, subprotocol: string): SocketLike;
  nowMs(): number;
  /** In [0, 1). */
  random(): number;
  setTimer(callback: () => void, ms: number): number;
  clearTimer(timer: number): void;
}

export interface ConnectionEvents {
  state(state: ConnectionState): void;
  greeting(greeting: GreetingInfo): void;
  frame(frame: ParsedFrame): void;
  diagnostics(diagnostics: DiagnosticsInfo): void;
  /** `boatId`: of the boat that the command made, else 0. */
  ack(commandId: number, appliedTick: number, boatId: number): void;
  reject(commandId: number, reason: string, field: string, message: string): void;
  parameterChanged(path: string, value: number): void;
  roomState(paused: boolean, speed: number): void;
  welcome(welcome: WelcomeInfo): void;
  people(people: PersonInfo[]): void;
  boatList(boats: BoatDetail[]): void;
  roomEvent(event: RoomEventName, message: string): void;
  /** The server's clock minus that of ConnectionWorld.nowMs() [ms]. */
  clock(leadMs: number): void;
  stats(stats: Omit<LinkStats, "overtakenCount">): void;
}

export class Connection {
  private socket: SocketLike | undefined;
  private state: ConnectionState = { name: "connecting" };
  private failedCount = 0;
  private liveSinceMs = 0;
  private lastHeardMs = 0;
  private lastPingMs = 0;
  private pingCount = 0;
  private retryTimer: number | undefined;
  private tickTimer: number | undefined;
  private greeting: GreetingInfo | undefined;
  private visible = true;
  private readonly pendingSinceMs = new Map<number, number>();
  private readonly meter: LinkMeter;
  private readonly unpacker = new PlaneUnpacker();
  private readonly clock = new ServerClock();
  private readonly governor = new LoadGovernor();
  private detail: DetailChoice = "auto";
  /** What the server gives what adapts at most. */
  private linkLevel: LevelName = "full";
  private askedForKeyframeMs = -Infinity;

  constructor(
    private readonly url: string,
    private readonly world: ConnectionWorld,
    private readonly events: ConnectionEvents,
    private identity: Identity = { name: "", token: "", resumeKey: "" },
  ) {
    this.meter = new LinkMeter(world.nowMs());
  }

  start(): void {
    if (this.tickTimer === undefined) this.scheduleTick();
    this.connect();
  }

  /** Ends for good. */
  stop(): void {
    if (this.tickTimer !== undefined) this.world.clearTimer(this.tickTimer);
    if (this.retryTimer !== undefined) this.world.clearTimer(this.retryTimer);
    this.tickTimer = this.retryTimer = undefined;
    this.dropSocket();
    this.failPending("the page closed the connection");
  }

  /** Tries now: after a refusal, or instead of waiting. */
  retryNow(): void {
    if (this.state.name !== "retrying" && this.state.name !== "refused") return;
    this.failedCount = 0;
    this.connect();
  }

  /** Another name or token: comes back under it, as the same person where the server still knows them. */
  introduce(name: string, token: string): void {
    this.identity = { ...this.identity, name, token };
    this.failedCount = 0;
    this.failPending("the page connects anew under another name");
    this.connect();
  }

  /** How much of the layers to ask for. */
  setDetail(detail: DetailChoice): void {
    if (detail === this.detail) return;
    this.detail = detail;
    if (this.state.name === "live") this.subscribe();
  }

  /** A hidden page is sent no frames; coming back asks for them again. */
  setVisible(visible: boolean): void {
    if (visible === this.visible) return;
    this.visible = visible;
    if (this.state.name === "live") this.subscribe();
  }

  /** Exactly one ack or reject follows: the server's, or a local one where nothing could be sent or nothing came back. */
  command(commandId: number, action: CommandAction): void {
    if (this.state.name !== "live") return this.rejectHere(commandId, "not connected to the server");
    if (this.pendingSinceMs.size >= kMaxPendingCount)
      return this.rejectHere(commandId, `${kMaxPendingCount} commands are waiting for an answer already; try again in a moment`);
    if (this.socket!.bufferedAmount > kMaxUnsentBytes)
      return this.rejectHere(commandId, "the link to the server is congested; try again in a moment");
    this.pendingSinceMs.set(commandId, this.world.nowMs());
    this.send(create(ClientMessageSchema, { message: { case: "command", value: { commandId: BigInt(commandId), action } } }));
  }

  private connect(): void {
    if (this.retryTimer !== undefined) this.world.clearTimer(this.retryTimer);
    this.retryTimer = undefined;
    this.dropSocket();
    this.setState({ name: "connecting" });
    this.lastHeardMs = this.world.nowMs();
    let socket: SocketLike;
    try {
      socket = this.world.openSocket(this.url, kSubprotocol);
    } catch (error) {
      this.setState({ name: "refused", reason: error instanceof Error ? error.message : String(error) });
      return;
    }
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      const version = { major: kWireMajor, minor: kWireMinor };
      this.send(create(ClientMessageSchema, { message: { case: "hello", value: { version, client: kClientName, ...this.identity } } }));
    };
    socket.onmessage = (event) => this.receive(event.data);
    socket.onclose = (event) => this.lost(event.reason || `closed by the server or the network (code ${event.code})`);
    // An error is always followed by a close, which carries what can be told.
    socket.onerror = () => {};
  }

  private receive(data: unknown): void {
    this.lastHeardMs = this.world.nowMs();
    this.read(data);
    this.meter.worked(this.world.nowMs() - this.lastHeardMs);
  }

  private read(data: unknown): void {
    if (!(data instanceof ArrayBuffer)) return this.meter.malformed("a text message");
    this.meter.bytes(data.byteLength);
    const parsed = parse(data);
    switch (parsed.kind) {
      case "malformed":
        return this.meter.malformed(parsed.reason);
      case "unknown":
        return;
      case "greeting":
        return this.greeted(parsed.greeting);
      case "packedSurface":
      case "packedFoam": {
        const unpacked = this.unpacker.unpack(parsed);
        if (unpacked.kind === "surface" || unpacked.kind === "foam") return this.gotFrame(unpacked);
        if (unpacked.kind === "malformed") this.meter.malformed(unpacked.reason);
        return this.askForKeyframe();
      }
      case "surface":
      case "particles":
      case "foam":
      case "bodies":
        return this.gotFrame(parsed);
      case "diagnostics":
        this.meter.diagnostics();
        return this.events.diagnostics(parsed.diagnostics);
      case "ack":
        if (this.pendingSinceMs.delete(Number(parsed.commandId)))
          this.events.ack(Number(parsed.commandId), Number(parsed.appliedTick), parsed.boatId);
        return;
      case "reject":
        if (this.pendingSinceMs.delete(Number(parsed.commandId)))
          this.events.reject(Number(parsed.commandId), parsed.reason, parsed.field, parsed.message);
        return;
      case "parameterChanged":
        return this.events.parameterChanged(parsed.path, parsed.value);
      case "roomState":
        return this.events.roomState(parsed.paused, parsed.speed);
      case "welcome":
        // The next connection goes on as this person.
        this.identity = { ...this.identity, resumeKey: parsed.welcome.resumeKey };
        return this.events.welcome(parsed.welcome);
      case "people":
        return this.events.people(parsed.people);
      case "boatList":
        return this.events.boatList(parsed.boats);
      case "roomEvent":
        return this.events.roomEvent(parsed.event, parsed.message);
      case "levelChanged":
        this.linkLevel = parsed.level;
        return;
      case "pong":
        return this.ponged(parsed.clientTimeS * 1000, parsed.serverTimeS);
      case "refusal":
        return this.refuse(parsed.message);
    }
  }

  private gotFrame(frame: ParsedFrame): void {
    this.meter.frame(frame.kind, frame.header);
    this.events.frame(frame);
  }

  private ponged(sentMs: number, serverTimeS: number): void {
    const nowMs = this.world.nowMs();
    this.meter.roundTrip(nowMs - sentMs);
    this.clock.answered(sentMs, serverTimeS, nowMs);
    this.tellClock();
  }

  private tellClock(): void {
    const leadMs = this.clock.leadMs();
    if (leadMs !== undefined) this.events.clock(leadMs);
  }

  /** Subscribing again begins with one. */
  private askForKeyframe(): void {
    const nowMs = this.world.nowMs();
    if (nowMs - this.askedForKeyframeMs < kKeyframeEveryMs) return;
    this.askedForKeyframeMs = nowMs;
    this.subscribe();
  }

  private greeted(greeting: GreetingInfo): void {
    if (greeting.versionMajor !== kWireMajor)
      return this.refuse(`the server speaks version ${greeting.versionMajor}.${greeting.versionMinor} of the wire, this page ${kWireMajor}.${kWireMinor}; reload the page`);
    this.greeting = greeting;
    // A later one, of another scene, knows nothing new about the clock.
    if (this.clock.leadMs() === undefined) this.clock.greeted(greeting.serverTimeS, this.world.nowMs());
    if (this.state.name !== "live") {
      this.liveSinceMs = this.world.nowMs();
      this.setState({ name: "live" });
    }
    this.tellClock();
    this.events.greeting(greeting);
    this.subscribe();
    this.ping();
  }

  private subscribe(): void {
    if (!this.greeting) return;
    const offered = this.greeting.frameRateMaxHz;
    const frameRateHz = offered > 0 ? Math.min(offered, kFrameRateHz) : kFrameRateHz;
    for (const layer of this.greeting.layers) {
      const rateHz = layer === "diagnostics" ? Math.min(kDiagnosticsRateHz, frameRateHz) : frameRateHz;
      const maxRateHz = this.visible || layer === "diagnostics" ? rateHz : 0;
      const isAuto = this.detail === "auto";
      const level = kWireLevels[isAuto ? this.governor.level : (this.detail as LevelName)];
      const value = { layer: kLayers[layer], maxRateHz, packing: Packing.PACKED, level, adapts: isAuto };
      this.send(create(ClientMessageSchema, { message: { case: "subscribe", value } }));
    }
  }

  private ping(): void {
    this.lastPingMs = this.world.nowMs();
    if (this.socket!.bufferedAmount > kMaxUnsentBytes) return;
    ++this.pingCount;
    this.send(create(ClientMessageSchema, { message: { case: "ping", value: { clientTimeS: this.lastPingMs / 1000 } } }));
  }

  private scheduleTick(): void {
    this.tickTimer = this.world.setTimer(() => {
      this.scheduleTick();
      this.tick();
    }, kHousekeepingEveryMs);
  }

  private tick(): void {
    const nowMs = this.world.nowMs();
    this.events.stats({ ...this.meter.measure(nowMs), ...this.levelNow() });
    if (this.detail === "auto" && this.state.name === "live" && this.governor.note(this.meter.busyShare)) this.subscribe();
    for (const [commandId, sinceMs] of this.pendingSinceMs) {
      if (nowMs - sinceMs < kAnswerPatienceMs) continue;
      this.pendingSinceMs.delete(commandId);
      this.rejectHere(commandId, `no answer for ${kAnswerPatienceMs / 1000} s`);
    }
    if (this.state.name !== "live" && this.state.name !== "connecting") return;
    if (nowMs - this.lastHeardMs > kSilenceMs) return this.lost(`no word from the server for ${kSilenceMs / 1000} s`);
    const pingEveryMs = this.pingCount < kFirstPings ? 0 : kPingEveryMs;
    if (this.state.name === "live" && nowMs - this.lastPingMs >= pingEveryMs) this.ping();
  }

  private levelNow(): Pick<LinkStats, "level" | "levelHeldBy"> {
    if (this.detail !== "auto") return { level: this.detail, levelHeldBy: this.detail === "full" ? "nobody" : "choice" };
    const level = lowerLevel(this.governor.level, this.linkLevel);
    if (level === "full") return { level, levelHeldBy: "nobody" };
    return { level, levelHeldBy: level === this.linkLevel ? "link" : "device" };
  }

  private lost(why: string): void {
    if (this.state.name !== "live" && this.state.name !== "connecting") return;
    this.failedCount = this.state.name === "live" && this.world.nowMs() - this.liveSinceMs >= kSettledMs ? 1 : this.failedCount + 1;
    this.dropSocket();
    this.failPending("the connection was lost before the answer came");
    const inS = backoffS(this.failedCount, this.world.random());
    this.setState({ name: "retrying", inS, why });
    this.retryTimer = this.world.setTimer(() => this.connect(), inS * 1000);
  }

  private refuse(reason: string): void {
    this.dropSocket();
    this.failPending("the server refused the connection");
    this.setState({ name: "refused", reason });
  }

  private dropSocket(): void {
    const socket = this.socket;
    this.socket = undefined;
    this.greeting = undefined;
    this.unpacker.forget();
    this.meter.forgetRoundTrips();
    this.clock.forget();
    this.pingCount = 0;
    this.linkLevel = "full";
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = socket.onerror = null;
    socket.close();
  }

  private send(message: ClientMessage): void {
    this.socket?.send(toBinary(ClientMessageSchema, message));
  }

  private setState(state: ConnectionState): void {
    this.state = state;
    this.events.state(state);
  }

  private rejectHere(commandId: number, message: string): void {
    this.events.reject(commandId, "NOT_SENT", "", message);
  }

  private failPending(message: string): void {
    const commandIds = [...this.pendingSinceMs.keys()];
    this.pendingSinceMs.clear();
    for (const commandId of commandIds) this.rejectHere(commandId, message);
  }
}
