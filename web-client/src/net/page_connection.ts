// The page's connection: which layers it wants, at what rate and level, follows from what the page shows and what this device can unpack.
// Runs in the worker.
import type { GreetingInfo } from "../../client/codec/greeting";
import { kLayerNames } from "../../client/codec/layers";
import { Connection } from "../../client/session/connection";
import type { ConnectionEvent, Identity, Subscription } from "../../client/session/events";
import type { ConnectionSink, ConnectionWorld } from "../../client/session/world";
import { LoadGovernor, shownLevel } from "./load_governor";
import type { PageConnectionEvent, PageWishes } from "./messages";

/** Version of the program; vite.config.ts defines it. */
declare const __PROGRAM_VERSION__: string;
const kClientName = `spindrift-web ${__PROGRAM_VERSION__}`;
const kAnswerWithinS = 10;
const kDiagnosticsRateHz = 10;

export class PageConnection {
  readonly session: Connection;
  private readonly governor = new LoadGovernor();
  private isLive = false;
  private wishes: PageWishes = { detail: "auto", exactParticles: false, layers: kLayerNames, frameRateHz: 60, visible: true };

  constructor(
    url: string,
    world: ConnectionWorld,
    private readonly sink: ConnectionSink<PageConnectionEvent>,
    identity: Identity = { name: "", token: "", resumeKey: "" },
  ) {
    const options = { url, client: kClientName, identity, answerWithinS: kAnswerWithinS, subscriptions: (greeting: GreetingInfo) => this.subscriptions(greeting) };
    this.session = new Connection(options, world, { event: (event) => this.report(event), frame: (frame) => sink.frame(frame) });
  }

  /** Changes what the page wants; what is left out stays. */
  want(change: Partial<PageWishes>): void {
    const before = this.wishes;
    this.wishes = { ...before, ...change };
    if (this.isLive && Object.entries(this.wishes).some(([name, value]) => value !== before[name as keyof PageWishes])) this.session.subscribe();
  }

  private *subscriptions({ layers, frameRateMaxHz: offeredHz }: GreetingInfo): Generator<Subscription> {
    const { detail, exactParticles, visible, ...wishes } = this.wishes;
    const frameRateHz = offeredHz > 0 ? Math.min(offeredHz, wishes.frameRateHz) : wishes.frameRateHz;
    const adapts = detail === "auto";
    const level = adapts ? this.governor.level : detail;
    for (const layer of layers) {
      const rateHz = layer === "diagnostics" ? Math.min(kDiagnosticsRateHz, frameRateHz) : frameRateHz;
      const isShown = wishes.layers.includes(layer) && (visible || layer === "diagnostics");
      yield { layer, maxRateHz: isShown ? rateHz : 0, packed: layer !== "particles" || !exactParticles, level, adapts };
    }
  }

  private report(event: ConnectionEvent): void {
    if (event.kind === "state") this.isLive = event.state.name === "live";
    if (event.kind !== "stats") return this.sink.event(event);
    const { detail } = this.wishes;
    this.sink.event({ kind: "stats", stats: { ...event.stats, ...shownLevel(detail, this.governor.level, event.stats.linkLevel) } });
    if (detail === "auto" && this.isLive && this.governor.note(event.stats.busyShare)) this.session.subscribe();
  }
}
