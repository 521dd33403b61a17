// Shows the values measured by the server and the page. Each value is written when it arrives.
import type { GreetingInfo } from "../codec/greeting";
import type { DiagnosticsInfo } from "../codec/parse";
import type { ConnectionState, LinkStats } from "../net/messages";
import { byId, make, setText } from "./dom";
import { showRooms } from "./room_links";
import { kTexts } from "./texts";

export function describeState(state: ConnectionState): string {
  switch (state.name) {
    case "connecting":
      return "connecting";
    case "opening":
      return `opening the room ${state.room}`;
    case "live":
      return "live";
    case "retrying":
      return `retrying in ${state.inS < 1 ? state.inS.toFixed(1) : Math.round(state.inS)} s`;
    case "refused":
      return `refused: ${state.reason}`;
  }
}

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

  diagnostics(d: DiagnosticsInfo): void {
    setText(this.boats, String(d.boatCount));
    setText(this.breaking, `${(100 * d.breakingRatio).toFixed(2)} %`);
    setText(this.volumeError, `${d.volumeErrorUnits} units`);
    this.volumeError.classList.toggle("trouble", d.volumeErrorUnits !== 0n);
    setText(this.exchanged, `${d.emittedM3.toFixed(3)} / ${d.absorbedM3.toFixed(3)} m³`);
    setText(this.simTime, `${d.timeS.toFixed(2)} s`);
    setText(this.rtf, `${d.realTimeFactor.toFixed(2)} ×`);
    setText(this.particles, d.particleCount.toLocaleString("en"));
    setText(this.stepMs, `${d.stepMs.toFixed(2)} ms`);
    setText(this.substeps, String(d.substepsCount));
    const counts: [bigint, string][] = [
      [d.nonfiniteCount, "non-finite values"],
      [d.escapedCount, "escaped particles"],
      [d.recoveredCount, "recoveries"],
    ];
    const trouble = counts.filter(([count]) => count > 0n);
    setText(this.health, trouble.map(([count, what]) => `${count} ${what}`).join(", ") || "healthy");
    this.health.classList.toggle("trouble", trouble.length > 0);
    this.writePasses(d);
  }

  link(stats: LinkStats): void {
    setText(this.netFps, stats.framesPerS.toFixed(1));
    setText(this.kbps, stats.kilobytesPerS.toFixed(stats.kilobytesPerS < 10 ? 1 : 0));
    setText(this.latency, stats.latencyMs === undefined ? "–" : `${stats.latencyMs.toFixed(1)} ms`);
    const why = { none: "", choice: "", link: " (slow link)", device: " (busy device)" }[stats.levelLimitedBy];
    setText(this.level, stats.level + why);
  }

  /** `delayS`: age of the water shown. */
  display(framesPerS: number, delayS: number | undefined): void {
    setText(this.delay, delayS === undefined ? "–" : `${(1000 * delayS).toFixed(0)} ms`);
    setText(this.displayFps, framesPerS.toFixed(0));
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
    setText(this.lastAck, `command ${commandId} at tick ${appliedTick}`);
  }

  private showState(): void {
    const { shown: state, isPaused } = this;
    const isStill = state.name === "live" && isPaused;
    setText(this.state, isStill ? kTexts.paused : describeState(state));
    this.state.dataset["state"] = isStill ? "paused" : state.name;
    this.state.title = state.name === "retrying" ? state.why : "";
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
      setText(value!, `${ms.toFixed(2)} ms`);
      bar!.style.setProperty("--share", `${Math.min((ms / Math.max(d.stepMs, 1e-6)) * 100, 100)}%`);
    });
  }
}
