// A room of a server, for programs: frames, commands, and what is known of the room.
import type { BoatDetail, GreetingInfo, ParameterInfo } from "../codec/greeting";
import type { GameInfo } from "../codec/game";
import type { GroundGrid } from "../codec/ground";
import type { HullForcesInfo } from "../codec/hulls";
import { kLayerNames, type LayerName } from "../codec/layers";
import { kFreeLesson, type LessonInfo } from "../codec/lesson";
import type { PersonInfo, RoleName, WelcomeInfo } from "../codec/people";
import type { GaugeInfo } from "../codec/scene_info";
import { requestSeries } from "../rest/gauge_series";
import { requestGround } from "../rest/ground";
import { Connection } from "../session/connection";
import type { CommandAction, ConnectionEvent, Subscription } from "../session/events";
import { kSessionTexts } from "../session/texts";
import type { ConnectionWorld } from "../session/world";
import { restBase } from "./address";
import { Clock, kStepTicksMax } from "./clock";
import { checkFields, errorOf, kCommandNames, type Ack, type Commands } from "./commands";
import { ConnectionLost, Refused, SpindriftError } from "./errors";
import { Listeners, type WaterEvents } from "./events";
import type { FrameStream } from "./frame_stream";
import { diagnosticsOf, frameOf, type Frames, type Surface } from "./frames";
import { LayerInbox } from "./layer_inbox";
import type { GaugeRecord, LayerOptions, WaterSettings } from "./options";
import { Queries, type Answer, type Pairs, type QueryStreamOptions } from "./queries";

/** Frames of one stream that wait unless its reader says otherwise. */
const kWaitingFrames = 16;
const kRateMaxHz = 240;

interface PendingAnswer {
  action: CommandAction;
  resolve(ack: Ack): void;
  reject(error: Error): void;
}

/** A room of a server; `connect` gives one. It connects again by itself, as the same person with the same boats. Commands of the wire are
 *  methods: `water.splash({ xM: 1 })`. */
export class Water {
  /** Scene, layers, limits, device and version of the server, as it greeted last. */
  greeting!: GreetingInfo;
  /** Everybody in the room. */
  people: readonly PersonInfo[] = [];
  /** Hulls of all boats; the layer "bodies" has where they are. */
  boats: readonly BoatDetail[] = [];
  lesson: LessonInfo = kFreeLesson;
  /** Undefined without a game. */
  game: GameInfo | undefined;
  isPaused = false;
  /** Simulated seconds per second, as set. */
  speed = 1;
  /** Those who hold the room's clock; nobody: it runs by itself. */
  clockPersonIds: readonly number[] = [];
  /** What setParameter takes, by path: label, unit, bounds and present value. */
  readonly parameters = new Map<string, ParameterInfo>();
  /** Messages that could not be read. */
  damagedCount = 0;
  private welcome: WelcomeInfo | undefined;
  private live = false;
  private failure: SpindriftError | undefined;
  private lastWhy = "";
  private lastUrl: string;
  private nextCommandId = 1;
  private readonly answers = new Map<number, PendingAnswer>();
  private readonly wanted = new Map<LayerName, Subscription>();
  private readonly inboxes: { [L in LayerName]?: LayerInbox<Frames[L]> } = {};
  private hulls = new LayerInbox<HullForcesInfo>();
  private readonly queries = new Queries((action) => this.send(action));
  private readonly listeners = new Listeners();
  private readonly connection: Connection;
  private readonly first: Promise<void>;
  private settleFirst!: { resolve(): void; reject(error: Error): void };

  /** Use `connect`. */
  constructor(
    private readonly settings: WaterSettings,
    world: ConnectionWorld,
  ) {
    const { socketUrl: url, name, token, resumeKey, client, answerWithinS } = settings;
    this.lastUrl = url;
    this.first = new Promise((resolve, reject) => (this.settleFirst = { resolve, reject }));
    const options = { url, client, answerWithinS, identity: { name, token, resumeKey }, subscriptions: (greeting: GreetingInfo) => this.subscriptions(greeting) };
    this.connection = new Connection(options, world, {
      event: (event) => this.take(event),
      frame: (frame) => (this.inboxes[frame.kind] as LayerInbox<unknown> | undefined)?.put(frameOf(frame)),
      queryAnswer: (answer) => this.queries.take(answer),
      hullForces: ({ tick, timeS, stateId, hulls }) => this.hulls.put({ tick, timeS, stateId, hulls }),
    });
  }

  /** Connects for the first time. Rejects with Refused or, after `patienceS`, with ConnectionLost. */
  async open(patienceS: number): Promise<this> {
    this.connection.start();
    const timer = setTimeout(() => this.end(new ConnectionLost(`no connection to ${this.settings.socketUrl} within ${patienceS} s${this.lastWhy && `: ${this.lastWhy}`}`)), patienceS * 1000);
    try {
      await this.first;
      return this;
    } finally {
      clearTimeout(timer);
    }
  }

  /** Leaves the room. Streams end; commands under way are rejected. The server gives the boats back after its grace time. */
  close(): void {
    this.end(undefined);
  }

  // ---- what is known of the room

  /** Commands can be sent. */
  get isLive(): boolean {
    return this.live;
  }

  /** Address of the socket; that of another server after a move. */
  get url(): string {
    return this.connection.url;
  }

  get role(): RoleName {
    return this.welcome?.role ?? "viewer";
  }

  /** Of this client. */
  get personId(): number {
    return this.welcome?.personId ?? 0;
  }

  /** Secret. `connect` with it is the same person, within the server's grace time. */
  get resumeKey(): string {
    return this.welcome?.resumeKey ?? "";
  }

  /** Those of the scene; frames of "diagnostics" have all with their readings. */
  get gauges(): readonly GaugeInfo[] {
    return this.greeting.gauges;
  }

  /** By layer: frames that streams dropped for newer ones because nobody took them in time. "hullForces": of streams of those. */
  get dropped(): Partial<Record<LayerName | "hullForces", number>> {
    const hulls = this.hulls.dropped > 0 ? { hullForces: this.hulls.dropped } : {};
    return Object.fromEntries([...Object.entries(this.inboxes).map(([layer, inbox]) => [layer, inbox.dropped]), ...Object.entries(hulls)]);
  }

  /** Returns what takes the listener away again. */
  on<K extends keyof WaterEvents>(kind: K, listener: (event: WaterEvents[K]) => void): () => void {
    return this.listeners.on(kind, listener);
  }

  /** The next event of a kind. Rejects if nothing comes any more. */
  once<K extends keyof WaterEvents>(kind: K): Promise<WaterEvents[K]> {
    return new Promise((resolve, reject) => {
      if (this.failure) return reject(this.failure);
      const forget = [this.on(kind, (event) => settle(() => resolve(event))), this.on("closed", () => settle(() => reject(this.failure)))];
      const settle = (how: () => void): void => {
        for (const each of forget) each();
        how();
      };
    });
  }

  // ---- frames

  /** Asks for frames of a layer; without it, the first use of a layer asks with the defaults. Throws a RangeError. */
  subscribe(layer: LayerName, { rateHz = 60, packed = true, level = "full", adapts = false }: LayerOptions = {}): void {
    if (!kLayerNames.includes(layer)) throw new RangeError(`there is no layer ${JSON.stringify(layer)}; there are ${kLayerNames.join(", ")}`);
    if (!(rateHz >= 0 && rateHz <= kRateMaxHz)) throw new RangeError(`rateHz ${rateHz}: expected 0 to ${kRateMaxHz}`);
    this.wanted.set(layer, { layer, maxRateHz: rateHz, packed, level, adapts });
    (this.inboxes[layer] as LayerInbox<Frames[LayerName]> | undefined) ??= new LayerInbox();
    if (this.live) this.connection.subscribe(layer);
  }

  /** The newest frame of a layer that this did not return before; waits for one. */
  async next<L extends LayerName>(layer: L): Promise<Frames[L]> {
    return this.inbox(layer).next();
  }

  /** Every frame from now on, in order; at most `capacity` (1 to 4096) wait, then the oldest are dropped and counted. */
  frames<L extends LayerName>(layer: L, { capacity = kWaitingFrames } = {}): FrameStream<Frames[L]> {
    return this.inbox(layer).stream(capacity);
  }

  /** next("surface") */
  surface(): Promise<Surface> {
    return this.next("surface");
  }

  /** The first surface of this tick or a later one. */
  async surfaceAt(tick: number): Promise<Surface> {
    for (;;) {
      const frame = await this.surface();
      if (frame.tick >= tick) return frame;
    }
  }

  // ---- commands and requests

  /** Sends a command by its name; each name is a method too. At most 64 wait for their answers. */
  async command<K extends keyof Commands>(name: K, fields?: Parameters<Commands[K]>[0]): Promise<Ack> {
    const action = { case: name, value: fields ?? {} } as CommandAction;
    checkFields(name, action.value);
    return this.send(action);
  }

  private async send(action: CommandAction): Promise<Ack> {
    if (this.failure) throw this.failure;
    const commandId = this.nextCommandId++;
    return new Promise<Ack>((resolve, reject) => {
      this.answers.set(commandId, { action, resolve, reject });
      try {
        this.connection.command(commandId, action);
      } catch (error) {
        this.answers.delete(commandId);
        reject(new TypeError(error instanceof Error ? error.message : String(error)));
      }
    });
  }

  /** Stops the room's clock: from now on it advances only by steps of those who hold the clock. For operators, and for players who are alone in
   *  their room. `speed`: simulated seconds per second of the steps, 0: as fast as the machine can. `timeoutS`: a holder who sends no
   *  step for so long, while the room waits for it, loses the clock. Rejects as commands do. */
  async takeClock(fields?: Parameters<Commands["takeClock"]>[0]): Promise<Clock> {
    await this.command("takeClock", fields);
    return new Clock(this);
  }

  /** The water at points now, at most 1,024 of all queries that wait or stream. Points outside of the water are marked. Rejects as commands do,
   *  and with TypeError and RangeError for anything but points. */
  async query(points: Pairs): Promise<Answer> {
    return this.queries.once(points, this.settings.answerWithinS);
  }

  /** An answer now, and one whenever `intervalTicks` have passed, until the loop is left. The loop ends with ConnectionLost when the connection is
   *  lost, and with SpindriftError when the scene changes: ask again then. Throws TypeError and RangeError. */
  streamQuery(points: Pairs, options: QueryStreamOptions = {}): FrameStream<Answer> {
    return this.queries.stream(points, options);
  }

  /** The newest forces on the boats that this client moves (moveBoat) that this did not return before; waits for some. Rejects with ConnectionLost
   *  when the connection is lost: move the boats again then. */
  hullForces(): Promise<HullForcesInfo> {
    return this.failure ? Promise.reject(this.failure) : this.hulls.next();
  }

  /** Those of every tick, in order; at most `capacity` (1 to 4096) wait, then the oldest are dropped and counted. Ends as hullForces. */
  streamHullForces({ capacity = kWaitingFrames } = {}): FrameStream<HullForcesInfo> {
    if (this.failure) throw this.failure;
    return this.hulls.stream(capacity);
  }

  /** Advances a paused room by so many ticks and returns the surface after the last of them. */
  async advance(tickCount: number): Promise<Surface> {
    if (!(Number.isInteger(tickCount) && tickCount >= 1)) throw new RangeError(`tickCount ${tickCount}: expected a whole number above 0`);
    for (let left = tickCount; ; left -= kStepTicksMax) {
      const ticks = Math.min(left, kStepTicksMax);
      const { appliedTick } = await this.command("step", { tickCount: ticks });
      const surface = await this.surfaceAt(appliedTick + ticks);
      if (left <= kStepTicksMax) return surface;
    }
  }

  /** What a gauge measured at the last 4,096 ticks. Rejects with SpindriftError. */
  async gauge(name: string): Promise<GaugeRecord> {
    const series = await request(requestSeries(this.greeting.room, name, this.settings.token, restBase(this.url)));
    return { timeS: Float64Array.from(series.timeS), elevationM: Float64Array.from(series.elevationM), velocityXMps: Float64Array.from(series.velocityXMps), velocityZMps: Float64Array.from(series.velocityZMps) };
  }

  /** The ground of a room with a bed. Rejects with SpindriftError. */
  ground(): Promise<GroundGrid> {
    const { room } = this.greeting;
    return request(requestGround(`${restBase(this.url)}api/v1/rooms/${encodeURIComponent(room)}/ground`, room, this.settings.token));
  }

  // ---- the connection

  private inbox<L extends LayerName>(layer: L): LayerInbox<Frames[L]> {
    if (this.failure) throw this.failure;
    if (kLayerNames.includes(layer) && !this.greeting.layers.includes(layer)) throw new SpindriftError(`the room has no layer ${layer}; it has ${this.greeting.layers.join(", ")}`);
    if (!this.wanted.has(layer)) this.subscribe(layer);
    return this.inboxes[layer]!;
  }

  private *subscriptions({ layers, frameRateMaxHz }: GreetingInfo): Generator<Subscription> {
    for (const wanted of this.wanted.values())
      if (layers.includes(wanted.layer)) yield { ...wanted, maxRateHz: frameRateMaxHz > 0 ? Math.min(wanted.maxRateHz, frameRateMaxHz) : wanted.maxRateHz };
  }

  private take(event: ConnectionEvent): void {
    switch (event.kind) {
      case "state":
        return this.changeState(event.state);
      case "ack": case "reject":
        return this.answer(event);
      case "diagnostics":
        return this.inboxes.diagnostics?.put(diagnosticsOf(event.diagnostics));
      case "stats":
        this.damagedCount = event.stats.malformedCount;
        return this.listeners.emit("stats", event.stats);
      case "welcome":
        return this.welcomed(event.welcome);
      case "draining":
        return this.listeners.emit("draining", event.draining);
      case "clock":
        return;
      case "greeting":
        this.greeted(event.greeting);
        return this.listeners.emit("greeting", event.greeting);
      default: {
        const { kind, ...message } = event;
        this.note(event);
        return this.listeners.emit(kind, message as never);
      }
    }
  }

  private greeted(greeting: GreetingInfo): void {
    this.greeting = greeting;
    this.boats = greeting.boats;
    this.isPaused = greeting.paused;
    this.speed = greeting.speed;
    this.clockPersonIds = greeting.clockPersonIds;
    this.parameters.clear();
    for (const each of greeting.parameters) this.parameters.set(each.path, each);
  }

  private note(event: ConnectionEvent): void {
    if (event.kind === "people") this.people = event.people;
    else if (event.kind === "boatList") this.boats = event.boats;
    else if (event.kind === "lesson") this.lesson = event.lesson;
    else if (event.kind === "game") this.game = event.game;
    else if (event.kind === "roomState") [this.isPaused, this.speed, this.clockPersonIds] = [event.paused, event.speed, event.clockPersonIds];
    else if (event.kind === "parameterChanged") {
      const described = this.parameters.get(event.path);
      if (described) described.value = event.value;
    }
  }

  private welcomed(welcome: WelcomeInfo): void {
    const isFirst = this.welcome === undefined;
    this.welcome = welcome;
    this.live = true;
    this.settleFirst.resolve();
    if (this.url !== this.lastUrl) this.listeners.emit("moved", { url: (this.lastUrl = this.url) });
    if (!isFirst) this.listeners.emit(welcome.resumed ? "resumed" : "connected", welcome);
  }

  private changeState(state: Extract<ConnectionEvent, { kind: "state" }>["state"]): void {
    if (state.name === "live") return;
    this.live = false;
    const lost = new ConnectionLost("the connection was lost", true);
    this.queries.endAll(lost);
    this.hulls = this.hulls.endedBy(lost);
    if (state.name === "refused") return this.end(new Refused(state.reason, state.rooms));
    if (state.name !== "retrying") return;
    this.lastWhy = state.why;
    this.listeners.emit("disconnected", { why: state.why, retryInS: state.inS });
  }

  private answer(event: Extract<ConnectionEvent, { kind: "ack" | "reject" }>): void {
    const answer = this.answers.get(Number(event.commandId));
    if (!answer) return;
    this.answers.delete(Number(event.commandId));
    if (event.kind === "ack") {
      const { appliedTick, boatId, floaterId, gaugeId, stateHash } = event;
      return answer.resolve({ appliedTick: Number(appliedTick), boatId, floaterId, gaugeId, stateHash });
    }
    answer.reject(errorOf(event, answer.action, this.parameters, this.live));
  }

  /** Ends for good, once. `error` undefined: as the program wanted. */
  private end(error: SpindriftError | undefined): void {
    if (this.failure) return;
    this.failure = error ?? new ConnectionLost(kSessionTexts.closedHere);
    this.live = false;
    this.connection.stop();
    for (const inbox of [...Object.values(this.inboxes), this.hulls]) inbox.finish(this.failure, error !== undefined);
    this.queries.endAll(error);
    this.settleFirst.reject(this.failure);
    this.listeners.emit("closed", { error });
  }
}

/** A method for each command of the wire. */
export interface Water extends Omit<Commands, "takeClock"> {}

for (const name of kCommandNames.filter((name) => !(name in Water.prototype)))
  Object.defineProperty(Water.prototype, name, {
    value(this: Water, fields?: never): Promise<Ack> {
      return this.command(name, fields);
    },
  });

async function request<T>(answer: Promise<T>): Promise<T> {
  try {
    return await answer;
  } catch (error) {
    throw new SpindriftError(error instanceof Error ? error.message : String(error), { cause: error });
  }
}
