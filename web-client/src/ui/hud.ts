// Shows the values measured by the server and the page.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { DiagnosticsInfo } from "../../client/codec/parse";
import type { ConnectionState } from "../../client/session/events";
import type { LinkStats } from "../net/messages";
import { byId, make, setText } from "./dom";
import { showRooms } from "./room_links";
import { kTexts } from "./texts";
import { fixed, grouped } from "./numbers";

export function describeState(state: ConnectionState): string {
  switch (state.name) {
    case "connecting":
      return kTexts.states.connecting;
    case "opening":
      return kTexts.states.opening(state.room);
    case "live":
      return kTexts.states.live;
    case "retrying":
      return kTexts.states.retrying(state.inS);
    case "refused":
      return kTexts.states.refused(state.reason);
  }
}

/** Nobody reads the server's values as fast as they come. */
const kDiagnosticsEveryMs = 200;

export class Hud {
  private readonly simTime = byId("sim-time");
  private readonly rtf = byId("rtf");
  private readonly netFps = byId("net-fps");
  private readonly displayFps = byId("display-fps");
  private readonly kbps = byId("kbps");
  private readonly latency = byId("latency");
  private readonly delay = byId("delay");
  private readonly level = byId("level");
  private readonly particles = byId("particles");
  private readonly stepMs = byId("step-ms");
  private readonly substeps = byId("substeps");
  private readonly device = byId("device");
  private readonly state = byId("state");
  private readonly retry = byId("retry");
  private readonly boats = byId("boat-count");
  private readonly breaking = byId("breaking");
  private readonly volumeError = byId("volume-error");
  private readonly exchanged = byId("exchanged");
  private readonly lastAck = byId("last-ack");
  private readonly passes = byId("passes");
  private readonly health = byId("health");
  private shown: ConnectionState = { name: "connecting" };
  private isPaused = false;
  /** What came last, until it is written. */
  private latest: DiagnosticsInfo | undefined;

  /** Shows only the rows that this room has values for. */
  enter(greeting: GreetingInfo): void {
    const breaks = greeting.isTwoWay || greeting.layers.includes("foam");
    const rows: [HTMLElement, boolean][] = [
      [this.boats, greeting.hasBoats],
      [this.breaking, breaks],
      [this.volumeError, greeting.isTwoWay],
      [this.exchanged, greeting.isTwoWay],
      [this.particles, greeting.hasParticles],
    ];
    for (const [value, isShown] of rows) value.parentElement!.hidden = !isShown;
    setText(this.device, greeting.device);
    this.device.title = greeting.device;
  }

  diagnostics(diagnostics: DiagnosticsInfo): void {
    if (!this.latest) setTimeout(() => this.writeDiagnostics(this.latest!), kDiagnosticsEveryMs);
    this.latest = diagnostics;
  }

  link(stats: LinkStats): void {
    setText(this.netFps, fixed(stats.framesPerS, 1));
    setText(this.kbps, fixed(stats.kilobytesPerS, stats.kilobytesPerS < 10 ? 1 : 0));
    setText(this.latency, stats.latencyMs === undefined ? "–" : `${fixed(stats.latencyMs, 1)} ms`);
    setText(this.level, kTexts.levels[stats.level] + kTexts.levelLimits[stats.levelLimitedBy]);
  }

  /** `delayS`: age of the water shown. */
  display(framesPerS: number, delayS: number | undefined): void {
    setText(this.delay, delayS === undefined ? "–" : `${fixed(1000 * delayS, 0)} ms`);
    setText(this.displayFps, fixed(framesPerS, 0));
  }

  connection(state: ConnectionState): void {
    this.shown = state;
    this.showState();
    this.retry.hidden = state.name !== "retrying" && state.name !== "refused";
    showRooms(byId("other-rooms"), state.name === "refused" ? state.rooms : [], location.href);
  }

  paused(isPaused: boolean): void {
    this.isPaused = isPaused;
    this.showState();
  }

  acked(commandId: number, appliedTick: number): void {
    setText(this.lastAck, kTexts.commandAt(commandId, appliedTick));
  }

  private showState(): void {
    const { shown: state, isPaused } = this;
    const isStill = state.name === "live" && isPaused;
    setText(this.state, isStill ? kTexts.paused : describeState(state));
    this.state.dataset["state"] = isStill ? "paused" : state.name;
    this.state.title = state.name === "retrying" ? state.why : "";
  }

  private writeDiagnostics(d: DiagnosticsInfo): void {
    this.latest = undefined;
    setText(this.boats, String(d.boatCount));
    setText(this.breaking, `${fixed(100 * d.breakingRatio, 2)} %`);
    setText(this.volumeError, kTexts.volumeUnits(d.volumeErrorUnits));
    this.volumeError.classList.toggle("trouble", d.volumeErrorUnits !== 0n);
    setText(this.exchanged, `${fixed(d.emittedM3, 3)} / ${fixed(d.absorbedM3, 3)} m³`);
    setText(this.simTime, `${fixed(d.timeS, 2)} s`);
    setText(this.rtf, `${fixed(d.realTimeFactor, 2)} ×`);
    setText(this.particles, grouped(d.particleCount));
    setText(this.stepMs, `${fixed(d.stepMs, 2)} ms`);
    setText(this.substeps, String(d.substepsCount));
    const counts: [bigint, (count: bigint) => string][] = [
      [d.nonfiniteCount, kTexts.nonfinite],
      [d.escapedCount, kTexts.escaped],
      [d.recoveredCount, kTexts.recovered],
    ];
    const trouble = counts.filter(([count]) => count > 0n);
    setText(this.health, trouble.map(([count, what]) => what(count)).join(", ") || kTexts.healthy);
    this.health.classList.toggle("trouble", trouble.length > 0);
    this.writePasses(d);
  }

  private writePasses(d: DiagnosticsInfo): void {
    while (this.passes.children.length > d.passes.length) this.passes.lastElementChild!.remove();
    d.passes.forEach(({ name, ms }, at) => {
      let row = this.passes.children[at] as HTMLElement | undefined;
      if (!row) {
        row = make("li", {}, [make("span"), make("span", { class: "bar" }), make("span")]);
        this.passes.append(row);
      }
      const [label, bar, value] = [...row.children] as HTMLElement[];
      setText(label!, name);
      setText(value!, `${fixed(ms, 2)} ms`);
      bar!.style.setProperty("--share", `${Math.min((ms / Math.max(d.stepMs, 1e-6)) * 100, 100)}%`);
    });
  }
}
