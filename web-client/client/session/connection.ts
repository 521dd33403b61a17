// One room over one WebSocket at a time: hello, subscriptions, commands and their answers, pings, and connecting again after a loss.
// Socket, clock and timers are injected, so tests need no network.
import { create, toBinary, type MessageInitShape } from "@bufbuild/protobuf";

import type { PlainFrame } from "../codec/frame_types";
import { FrameUnpacker } from "../codec/frame_unpacker";
import { kWireMajor, kWireMinor, type GreetingInfo } from "../codec/greeting";
import { kFinestLevel, kLayers, wireLevel, type LayerName } from "../codec/layers";
import { parse, type DrainingInfo } from "../codec/parse";
import { ClientMessageSchema, Packing } from "../gen/spindrift/v1/wire_pb";
import { backoffS } from "./backoff";
import type { CommandAction, ConnectionState, Identity, LocalReason, Subscription } from "./events";
import { LinkMeter } from "./link_meter";
import type { MissingRoom } from "./missing_room";
import { planMove, type MovePlan } from "./move_plan";
import { kMaxPendingCount, PendingCommands } from "./pending_commands";
import { ServerClock } from "./server_clock";
import { kSessionTexts } from "./texts";
import type { ConnectionSink, ConnectionWorld, SocketLike, Timer } from "./world";

const kSubprotocol = "spindrift.v1";
const kPingEveryMs = 2000;
/** The first pings go with every housekeeping tick: until they are answered, the server's clock is only estimated. */
const kFirstPings = 5;
const kHousekeepingEveryMs = 500;
/** Without a greeting, or without any message, for this long the connection counts as lost. */
const kSilenceMs = 10_000;
/** The server builds water for these, and waits for ticks in `step` that waits, as long as that takes; meanwhile everything else continues, and a lost connection ends the wait. */
const kSlowActions: readonly CommandAction["case"][] = ["changeScene", "setParameter"];
const kMaxUnsentBytes = 256 * 1024;
/** Shortest interval between two requests for a keyframe. */
const kKeyframeEveryMs = 1000;
/** After this long in state "live" the next loss starts with the shortest backoff again. */
const kSettledMs = 5000;

type ClientBody = Exclude<NonNullable<MessageInitShape<typeof ClientMessageSchema>["message"]>, { case: undefined }>;

export interface ConnectionOptions {
  url: string;
  /** Name and version of the program, for the server's log. */
  client: string;
  identity: Identity;
  /** Commands but those that build water are answered within this time, or count as unanswered. */
  answerWithinS: number;
  /** The subscriptions that are wanted in the room of this greeting. */
  subscriptions(greeting: GreetingInfo): Iterable<Subscription>;
}

export class Connection {
  private socket: SocketLike | undefined;
  private state: ConnectionState = { name: "connecting" };
  private failedCount = 0;
  private liveSinceMs = 0;
  private lastHeardMs = 0;
  private lastPingMs = 0;
  private pingCount = 0;
  private retryTimer: Timer | undefined;
  /** Set while the server is about to end: when and where to connect anew. */
  private move: MovePlan | undefined;
  private tickTimer: Timer | undefined;
  private greeting: GreetingInfo | undefined;
  private readonly pending = new PendingCommands();
  private readonly meter: LinkMeter;
  private readonly unpacker = new FrameUnpacker();
  private readonly clock = new ServerClock();
  /** The finest level that the server sends to adapting subscriptions. */
  private linkLevel = kFinestLevel;
  private lastKeyframeRequestMs = -Infinity;
  private identity: Identity;
  private socketUrl: string;

  constructor(
    private readonly options: ConnectionOptions,
    private readonly world: ConnectionWorld,
    private readonly sink: ConnectionSink,
  ) {
    this.meter = new LinkMeter(world.nowMs());
    this.identity = options.identity;
    this.socketUrl = options.url;
  }

  /** Address of the socket; that of another server after a move. */
  get url(): string {
    return this.socketUrl;
  }

  /** Connects, and again after each loss, until stop(). */
  start(): void {
    if (this.tickTimer === undefined) this.scheduleTick();
    this.connect();
  }

  /** Closes the connection for good. */
  stop(): void {
    if (this.tickTimer !== undefined) this.world.clearTimer(this.tickTimer);
    if (this.retryTimer !== undefined) this.world.clearTimer(this.retryTimer);
    this.tickTimer = this.retryTimer = undefined;
    this.state = { name: "connecting" };
    this.dropSocket();
    this.failPending(kSessionTexts.closedHere);
  }

  /** Connects now: after a refusal, or instead of waiting. */
  retryNow(): void {
    if (this.state.name !== "retrying" && this.state.name !== "refused") return;
    this.failedCount = 0;
    this.connect();
  }

  /** Connects anew with another name or token; the server resumes the same person if it still can. */
  introduce(name: string, token: string): void {
    this.identity = { ...this.identity, name, token };
    this.failedCount = 0;
    this.failPending(kSessionTexts.renamed);
    this.connect();
  }

  /** Exactly one ack or reject follows: the server's, or a local one if nothing was sent or no answer came. */
  command(commandId: number, action: CommandAction): void {
    if (this.state.name !== "live") return this.rejectHere(commandId, "NOT_SENT", kSessionTexts.notConnected);
    if (this.pending.isFull)
      return this.rejectHere(commandId, "NOT_SENT", kSessionTexts.tooManyWait(kMaxPendingCount));
    if (this.socket!.bufferedAmount > kMaxUnsentBytes)
      return this.rejectHere(commandId, "NOT_SENT", kSessionTexts.congested);
    // Throws for a value that its field cannot hold.
    const bytes = encode({ case: "command", value: { commandId: BigInt(commandId), action } });
    const isSlow = kSlowActions.includes(action.case) || (action.case === "step" && action.value.waits);
    this.pending.add(commandId, isSlow ? Infinity : this.world.nowMs() + this.options.answerWithinS * 1000);
    this.socket!.send(bytes);
  }

  private connect(): void {
    if (this.retryTimer !== undefined) this.world.clearTimer(this.retryTimer);
    this.retryTimer = undefined;
    if (this.move) this.socketUrl = this.move.url;
    this.move = undefined;
    this.dropSocket();
    this.setState({ name: "connecting" });
    this.lastHeardMs = this.world.nowMs();
    let socket: SocketLike;
    try {
      socket = this.world.openSocket(this.socketUrl, kSubprotocol);
    } catch (error) {
      this.setState({ name: "refused", reason: error instanceof Error ? error.message : String(error), rooms: [] });
      return;
    }
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    let isOpen = false;
    let fault: string | undefined;
    socket.onopen = () => {
      isOpen = true;
      const version = { major: kWireMajor, minor: kWireMinor };
      this.send({ case: "hello", value: { version, client: this.options.client, ...this.identity } });
    };
    socket.onmessage = (event) => this.receive(event.data);
    socket.onclose = (event) => {
      this.lost(event.reason || fault || kSessionTexts.closed(event.code));
      if (!isOpen) void this.askForRoom();
    };
    // A close follows every error. Browsers do not say what it was.
    socket.onerror = ({ message }) => {
      fault = message;
    };
  }

  private receive(data: unknown): void {
    this.lastHeardMs = this.world.nowMs();
    this.read(data);
    this.meter.worked(this.world.nowMs() - this.lastHeardMs);
  }

  /** Messages that the connection does not handle itself go to the sink unchanged. */
  private read(data: unknown): void {
    if (!(data instanceof ArrayBuffer)) return this.meter.malformed("a text message");
    this.meter.bytes(data.byteLength);
    const parsed = parse(data);
    switch (parsed.kind) {
      case "malformed":
        return this.meter.malformed(parsed.reason);
      case "unknown":
        return;
      case "packedSurface": case "packedFoam": case "packedParticles": case "packedFloaters": {
        const unpacked = this.unpacker.unpack(parsed);
        if (unpacked.kind !== "malformed" && unpacked.kind !== "missingBase") return this.deliver(unpacked);
        if (unpacked.kind === "malformed") this.meter.malformed(unpacked.reason);
        // The next frame of the particles is a keyframe anyway.
        if (parsed.kind !== "packedParticles") this.requestKeyframe();
        return;
      }
      case "surface": case "particles": case "foam": case "bodies": case "floaters":
        return this.deliver(parsed);
      case "levelChanged":
        this.linkLevel = parsed.level;
        return;
      case "draining":
        return this.drained(parsed.draining);
      case "pong":
        return this.ponged(parsed.clientTimeS * 1000, parsed.serverTimeS);
      case "refusal":
        this.refuse(parsed.message);
        return void this.addRooms();
      case "greeting":
        return this.greeted(parsed.greeting);
      case "queryAnswer":
        return this.sink.queryAnswer?.(parsed);
      case "hullForces":
        return this.sink.hullForces?.(parsed);
      case "diagnostics":
        this.meter.diagnostics();
        return this.sink.event(parsed);
      case "ack": case "reject":
        if (this.pending.answered(Number(parsed.commandId))) this.sink.event(parsed);
        return;
      case "welcome":
        this.identity = { ...this.identity, resumeKey: parsed.welcome.resumeKey };
        return this.sink.event(parsed);
      default:
        return this.sink.event(parsed);
    }
  }

  /** Stays until the planned moment if the server lets it, and connects anew then. */
  private drained(draining: DrainingInfo): void {
    this.move = planMove(draining, this.socketUrl, this.world.random(), this.world.nowMs());
    if (this.retryTimer !== undefined) this.world.clearTimer(this.retryTimer);
    this.retryTimer = this.world.setTimer(() => {
      this.failedCount = 0;
      this.failPending(kSessionTexts.moves);
      this.connect();
    }, this.move.atMs - this.world.nowMs());
    this.sink.event({ kind: "draining", draining });
  }

  private deliver(frame: PlainFrame): void {
    this.meter.frame(frame.kind, frame.header);
    this.sink.frame(frame);
  }

  private ponged(sentMs: number, serverTimeS: number): void {
    const nowMs = this.world.nowMs();
    this.meter.roundTrip(nowMs - sentMs);
    this.clock.answered(sentMs, serverTimeS, nowMs);
    this.reportClock();
  }

  private reportClock(): void {
    const leadMs = this.clock.leadMs();
    if (leadMs !== undefined) this.sink.event({ kind: "clock", leadS: leadMs / 1000 });
  }

  /** A new subscription begins with a keyframe. */
  private requestKeyframe(): void {
    const nowMs = this.world.nowMs();
    if (nowMs - this.lastKeyframeRequestMs < kKeyframeEveryMs) return;
    this.lastKeyframeRequestMs = nowMs;
    this.subscribe();
  }

  private greeted(greeting: GreetingInfo): void {
    if (greeting.versionMajor !== kWireMajor)
      return this.refuse(kSessionTexts.otherVersion(`${greeting.versionMajor}.${greeting.versionMinor}`, `${kWireMajor}.${kWireMinor}`));
    this.greeting = greeting;
    // The greeting of another scene does not change the estimate of the clock.
    if (this.clock.leadMs() === undefined) this.clock.greeted(greeting.serverTimeS, this.world.nowMs());
    if (this.state.name !== "live") {
      this.liveSinceMs = this.world.nowMs();
      this.setState({ name: "live" });
    }
    this.reportClock();
    this.sink.event({ kind: "greeting", greeting });
    this.subscribe();
    this.ping();
  }

  /** Sends what `options.subscriptions` wants now, of one layer or of all; before the greeting nothing. */
  subscribe(only?: LayerName): void {
    if (!this.greeting) return;
    for (const { layer, maxRateHz, packed, level, adapts } of this.options.subscriptions(this.greeting))
      if (only === undefined || layer === only) this.send({ case: "subscribe", value: { layer: kLayers[layer], maxRateHz, packing: packed ? Packing.PACKED : Packing.PLAIN, level: wireLevel(level), adapts } });
  }

  private ping(): void {
    this.lastPingMs = this.world.nowMs();
    // Who was told of the greeting may have stopped the connection.
    if (!this.socket || this.socket.bufferedAmount > kMaxUnsentBytes) return;
    ++this.pingCount;
    this.send({ case: "ping", value: { clientTimeS: this.lastPingMs / 1000 } });
  }

  private scheduleTick(): void {
    this.tickTimer = this.world.setTimer(() => {
      this.scheduleTick();
      this.tick();
    }, kHousekeepingEveryMs);
  }

  private tick(): void {
    const nowMs = this.world.nowMs();
    this.sink.event({ kind: "stats", stats: { ...this.meter.measure(nowMs), linkLevel: this.linkLevel } });
    for (const commandId of this.pending.takeOverdue(nowMs))
      this.rejectHere(commandId, "NO_ANSWER", kSessionTexts.noAnswer(this.options.answerWithinS));
    if (this.state.name !== "live" && this.state.name !== "connecting") return;
    if (nowMs - this.lastHeardMs > kSilenceMs) return this.lost(kSessionTexts.silent(kSilenceMs / 1000));
    const pingEveryMs = this.pingCount < kFirstPings ? 0 : kPingEveryMs;
    if (this.state.name === "live" && nowMs - this.lastPingMs >= pingEveryMs) this.ping();
  }

  private lost(why: string): void {
    if (this.state.name !== "live" && this.state.name !== "connecting") return;
    if (this.move) {
      this.dropSocket();
      this.failPending(kSessionTexts.restarts);
      return this.setState({ name: "retrying", inS: Math.max(0, this.move.atMs - this.world.nowMs()) / 1000, why: kSessionTexts.restarts });
    }
    this.failedCount = this.state.name === "live" && this.world.nowMs() - this.liveSinceMs >= kSettledMs ? 1 : this.failedCount + 1;
    this.dropSocket();
    this.failPending(kSessionTexts.lost);
    const inS = backoffS(this.failedCount, this.world.random());
    this.retryTimer = this.world.setTimer(() => this.connect(), inS * 1000);
    this.setState({ name: "retrying", inS, why });
  }

  /** Opens a missing room if the world can. One that this client was in was closed on purpose: it stays closed. */
  private async askForRoom(): Promise<void> {
    const attempt = this.failedCount;
    const missing = await this.world.findMissingRoom(this.socketUrl, this.identity.token);
    if (!missing || this.state.name !== "retrying" || this.failedCount !== attempt) return;
    if (this.retryTimer !== undefined) this.world.clearTimer(this.retryTimer);
    if (this.world.openRoom && this.liveSinceMs === 0) void this.openRoom(missing);
    else this.refuse(kSessionTexts.noRoom(missing.name), missing.rooms);
  }

  /** Adds the rooms that there are to a refusal, if this one was closed. */
  private async addRooms(): Promise<void> {
    const { state } = this;
    const missing = await this.world.findMissingRoom(this.socketUrl, this.identity.token);
    if (missing && state.name === "refused" && this.state === state) this.setState({ ...state, rooms: missing.rooms });
  }

  private async openRoom({ name, rooms }: MissingRoom): Promise<void> {
    this.setState({ name: "opening", room: name });
    const whyNot = await this.world.openRoom!(this.socketUrl, this.identity.token);
    if (this.state.name !== "opening") return;
    if (whyNot === undefined) this.connect();
    else this.refuse(kSessionTexts.noRoomBecause(name, whyNot), rooms);
  }

  private refuse(reason: string, rooms: string[] = []): void {
    this.dropSocket();
    this.failPending(kSessionTexts.refused);
    this.setState({ name: "refused", reason, rooms });
  }

  private dropSocket(): void {
    const socket = this.socket;
    this.socket = undefined;
    this.greeting = undefined;
    this.unpacker.forget();
    this.meter.forgetRoundTrips();
    this.clock.forget();
    this.pingCount = 0;
    this.linkLevel = kFinestLevel;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    // Sockets that are closed before they open report that as an error, which somebody has to take in Node.
    socket.onerror = () => {};
    socket.close();
  }

  private send(message: ClientBody): void {
    this.socket?.send(encode(message));
  }

  private setState(state: ConnectionState): void {
    this.state = state;
    this.sink.event({ kind: "state", state });
  }

  private rejectHere(commandId: number, reason: LocalReason, message: string): void {
    this.sink.event({ kind: "reject", commandId: BigInt(commandId), reason, field: "", message });
  }

  private failPending(message: string): void {
    for (const commandId of this.pending.takeAll()) this.rejectHere(commandId, "LOST", message);
  }
}

function encode(message: ClientBody): Uint8Array<ArrayBuffer> {
  return toBinary(ClientMessageSchema, create(ClientMessageSchema, { message }));
}
