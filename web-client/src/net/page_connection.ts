// The page's connection: which layers it wants, at what rate and level, follows from what the page shows and what this device can unpack.
// Runs in the worker.
import type { GreetingInfo } from "../../client/codec/greeting";
import { kLayerNames, type LayerName } from "../../client/codec/layers";
import { Connection } from "../../client/session/connection";
import type { CommandAction, ConnectionEvent, Identity, Subscription } from "../../client/session/events";
import type { ConnectionSink, ConnectionWorld } from "../../client/session/world";
import { LoadGovernor, shownLevel } from "./load_governor";
import type { ConnectionCalls, DetailChoice, PageConnectionEvent } from "./messages";

/** Version of the program; vite.config.ts defines it. */
declare const __PROGRAM_VERSION__: string;
const kClientName = `spindrift-web ${__PROGRAM_VERSION__}`;
const kAnswerWithinS = 10;
const kDiagnosticsRateHz = 10;

export class PageConnection implements ConnectionCalls {
  private readonly connection: Connection;
  private readonly governor = new LoadGovernor();
  private isLive = false;
  private visible = true;
  private frameRateMaxHz = 60;
  private layers: readonly LayerName[] = kLayerNames;
  private exactParticles = false;
  private detail: DetailChoice = "auto";

  constructor(
    url: string,
    world: ConnectionWorld,
    private readonly sink: ConnectionSink<PageConnectionEvent>,
    identity: Identity = { name: "", token: "", resumeKey: "" },
  ) {
    const options = { url, client: kClientName, identity, answerWithinS: kAnswerWithinS, subscriptions: (greeting: GreetingInfo) => this.subscriptions(greeting) };
    this.connection = new Connection(options, world, { event: (event) => this.report(event), frame: (frame) => sink.frame(frame) });
  }

  start(): void {
    this.connection.start();
  }

  stop(): void {
    this.connection.stop();
  }

  retryNow(): void {
    this.connection.retryNow();
  }

  introduce(name: string, token: string): void {
    this.connection.introduce(name, token);
  }

  command(commandId: number, action: CommandAction): void {
    this.connection.command(commandId, action);
  }

  setDetail(detail: DetailChoice): void {
    if (detail === this.detail) return;
    this.detail = detail;
    this.subscribe();
  }

  setExactParticles(exact: boolean): void {
    if (exact === this.exactParticles) return;
    this.exactParticles = exact;
    this.subscribe();
  }

  setLayers(layers: readonly LayerName[]): void {
    this.layers = layers;
    this.subscribe();
  }

  setFrameRate(maxHz: number): void {
    if (maxHz === this.frameRateMaxHz) return;
    this.frameRateMaxHz = maxHz;
    this.subscribe();
  }

  setVisible(visible: boolean): void {
    if (visible === this.visible) return;
    this.visible = visible;
    this.subscribe();
  }

  private subscribe(): void {
    if (this.isLive) this.connection.subscribe();
  }

  private *subscriptions({ layers, frameRateMaxHz: offeredHz }: GreetingInfo): Generator<Subscription> {
    const frameRateHz = offeredHz > 0 ? Math.min(offeredHz, this.frameRateMaxHz) : this.frameRateMaxHz;
    const level = this.detail === "auto" ? this.governor.level : this.detail;
    for (const layer of layers) {
      const rateHz = layer === "diagnostics" ? Math.min(kDiagnosticsRateHz, frameRateHz) : frameRateHz;
      const isShown = this.layers.includes(layer) && (this.visible || layer === "diagnostics");
      yield { layer, maxRateHz: isShown ? rateHz : 0, packed: layer !== "particles" || !this.exactParticles, level, adapts: this.detail === "auto" };
    }
  }

  private report(event: ConnectionEvent): void {
    if (event.kind === "state") this.isLive = event.state.name === "live";
    if (event.kind !== "stats") return this.sink.event(event);
    this.sink.event({ kind: "stats", stats: { ...event.stats, ...shownLevel(this.detail, this.governor.level, event.stats.linkLevel) } });
    if (this.detail === "auto" && this.isLive && this.governor.note(event.stats.busyShare)) this.subscribe();
  }
}
