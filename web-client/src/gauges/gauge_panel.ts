// The panel with the chart of the gauges: which gauges, which quantity and how much time; values under the cursor; pause; files. On wide
// windows it lies over the water, on narrow ones it is the first part of the sheet.
import type { GaugeInfo } from "../codec/scene_info";
import type { GaugeSeries } from "../net/gauge_request";
import { formatBy, make, setText } from "../ui/dom";
import { kGaugeTexts } from "../ui/gauge_texts";
import { SelectRow } from "../ui/select_row";
import { GaugeChart, type Line } from "./gauge_chart";
import { GaugeRecord, kQuantities, kQuantityInfos, type GaugeReadingInfo, type Quantity } from "./gauge_record";

const kSpansS = [10, 30, 60];
/** Lines of the first gauges, then again from the first one. */
const kColors = ["#5fd4e6", "#f2c562", "#8be8b0", "#ff9d8a", "#c3a6ff", "#f58fd0", "#b7d36a", "#8fb3ff"];
/** Lines that are shown at first; more are hard to tell apart. */
const kFirstChosen = 5;
const kValueStep = 0.001;

/** What the panel needs of the page. */
export interface GaugeWorld {
  /** The title of the scene. */
  title(): string;
  /** Asks the server for the last ticks of a gauge. Throws an Error with a line for people. */
  requestSeries(gauge: string): Promise<GaugeSeries>;
  save(blob: Blob, extension: string): void;
  fail(text: string): void;
}

interface Key {
  button: HTMLButtonElement;
  value: HTMLElement;
}

export class GaugePanel {
  readonly element: HTMLElement;
  private readonly record = new GaugeRecord();
  private readonly chart: GaugeChart;
  private readonly keys = new Map<string, Key>();
  private readonly place = make("div", { class: "gauge-chart", "data-testid": "gauge-chart" });
  private readonly keyRow = make("div", { class: "gauge-keys", role: "group", "aria-label": kGaugeTexts.gauges });
  private readonly at = make("span", { class: "gauge-at", "data-testid": "gauge-at" });
  private readonly pauseButton: HTMLButtonElement;
  private readonly quantityRow = new SelectRow("gauge-quantity", kGaugeTexts.shows, (value) => this.choose({ quantity: value as Quantity }));
  private readonly spanRow = new SelectRow("gauge-span", kGaugeTexts.span, (value) => this.choose({ spanS: Number(value) }));
  private gauges: readonly GaugeInfo[] = [];
  private chosen = new Set<string>();
  private quantity: Quantity = "elevation";
  private spanS = 30;
  private isPaused = false;
  private isDrawn = true;
  private shown: { timesS: readonly number[]; columns: readonly (readonly (number | null)[])[]; names: readonly string[] } = { timesS: [], columns: [], names: [] };

  /** `closed`: the user has closed the panel. */
  constructor(
    private readonly world: GaugeWorld,
    closed: () => void,
  ) {
    const button = (testId: string, label: string, help: string, pressed: () => void): HTMLButtonElement => {
      const made = make("button", { type: "button", "data-testid": testId, title: help }, [label]);
      made.addEventListener("click", pressed);
      return made;
    };
    this.pauseButton = button("gauge-pause", kGaugeTexts.pause, kGaugeTexts.pauseHelp, () => void this.pause(!this.isPaused));
    this.quantityRow.setChoices(kQuantities.map((value) => ({ value, label: `${kGaugeTexts[value]} [${kQuantityInfos[value].unit}]` })), this.quantity);
    this.spanRow.setChoices(kSpansS.map((spanS) => ({ value: String(spanS), label: `${spanS} s` })), String(this.spanS));
    this.element = make("section", { class: "gauge-card glass", "data-testid": "gauge-panel", "aria-label": kGaugeTexts.gauges, hidden: "" }, [
      make("div", { class: "gauge-head" }, [
        make("h2", {}, [kGaugeTexts.gauges]),
        this.pauseButton,
        button("gauge-csv", kGaugeTexts.csv, kGaugeTexts.csvHelp, () => void this.saveCsv()),
        button("gauge-png", kGaugeTexts.picture, kGaugeTexts.pictureHelp, () => void this.savePng()),
        button("gauge-close", "×", kGaugeTexts.close, closed),
      ]),
      make("div", { class: "gauge-rows" }, [this.quantityRow.element, this.spanRow.element]),
      this.place,
      this.at,
      this.keyRow,
    ]);
    // The page's own keys choose tools.
    this.element.addEventListener("keydown", (event) => event.stopPropagation());
    this.chart = new GaugeChart(this.place, kGaugeTexts.time, () => this.showValues());
  }

  /** `isOtherWater`: what was read before does not belong to these gauges. */
  setGauges(gauges: readonly GaugeInfo[], isOtherWater: boolean): void {
    const isFirst = this.gauges.length === 0 || isOtherWater;
    if (isOtherWater) this.record.clear();
    const added = gauges.filter(({ name }) => isFirst || !this.gauges.some((before) => before.name === name));
    const chosen = isFirst ? [] : [...this.chosen].filter((name) => gauges.some((gauge) => gauge.name === name));
    this.chosen = new Set([...chosen, ...added.slice(0, Math.max(kFirstChosen - chosen.length, 0)).map(({ name }) => name)]);
    this.gauges = gauges;
    this.keys.clear();
    for (const { name } of gauges) {
      const value = make("span", { class: "gauge-value" });
      const key = make("button", { type: "button", "data-testid": `gauge-key-${name}` }, [make("i"), name, value]);
      key.style.setProperty("--line", this.lineOf(name).color);
      key.addEventListener("click", () => this.toggle(name));
      this.keys.set(name, { button: key, value });
    }
    this.keyRow.replaceChildren(...[...this.keys.values()].map(({ button }) => button));
    if (isFirst) this.hold(false);
    if (this.isOpen) void this.readHistory();
    this.draw();
  }

  get isOpen(): boolean {
    return !this.element.hidden;
  }

  open(): void {
    this.element.hidden = false;
    void this.readHistory();
    this.draw();
  }

  close(): void {
    this.element.hidden = true;
  }

  take(timeS: number, readings: readonly GaugeReadingInfo[]): void {
    if (!this.isOpen || this.isPaused) return;
    if (this.record.add(timeS, readings) === "anew") void this.readHistory();
    this.draw();
  }

  private lineOf(name: string): Line {
    const at = this.gauges.findIndex((gauge) => gauge.name === name);
    return { label: name, color: kColors[at % kColors.length]! };
  }

  private toggle(name: string): void {
    if (!this.chosen.delete(name)) {
      this.chosen.add(name);
      void this.readHistory([name]);
    }
    this.draw();
  }

  private choose(change: { quantity?: Quantity; spanS?: number }): void {
    Object.assign(this, change);
    this.draw();
  }

  /** Holds the chart with every tick of the history, or continues with what came meanwhile. */
  private async pause(isPaused: boolean): Promise<void> {
    this.hold(isPaused);
    await this.readHistory();
  }

  private hold(isPaused: boolean): void {
    this.isPaused = isPaused;
    setText(this.pauseButton, isPaused ? kGaugeTexts.resume : kGaugeTexts.pause);
    this.pauseButton.setAttribute("aria-pressed", String(isPaused));
  }

  /** Reads what the server keeps of the chosen gauges; while the chart is paused up to its newest time. */
  private async readHistory(names: readonly string[] = [...this.chosen]): Promise<void> {
    await Promise.all(
      names.map(async (name) => {
        try {
          const series = await this.world.requestSeries(name);
          if (this.keys.has(name)) this.record.merge(name, series, this.isPaused ? this.record.newestS : undefined);
        } catch (error) {
          this.world.fail(kGaugeTexts.noHistory(name, reasonOf(error)));
        }
      }),
    );
    this.draw();
  }

  /** Many changes make one picture. */
  private draw(): void {
    if (!this.isDrawn || !this.isOpen) return;
    this.isDrawn = false;
    requestAnimationFrame(() => {
      this.isDrawn = true;
      const names = this.gauges.map(({ name }) => name).filter((name) => this.chosen.has(name));
      const { timesS, columns } = this.record.view(names, this.quantity, this.spanS);
      this.shown = { timesS, columns, names };
      this.chart.show(timesS, columns, names.map((name) => this.lineOf(name)));
      this.showValues();
    });
  }

  private showValues(): void {
    const { timesS, columns, names } = this.shown;
    const at = this.chart.cursorAt ?? timesS.length - 1;
    const timeS = timesS[at];
    const when = timeS === undefined ? kGaugeTexts.noReadings : this.chart.cursorAt === undefined && !this.isPaused ? kGaugeTexts.newest : kGaugeTexts.at(timeS);
    setText(this.at, names.length === 0 ? kGaugeTexts.none : when);
    for (const [name, { button, value }] of this.keys) {
      const isShown = this.chosen.has(name);
      button.setAttribute("aria-pressed", String(isShown));
      const read = columns[names.indexOf(name)]?.[at];
      setText(value, !isShown ? "" : read === null || read === undefined ? "–" : `${formatBy(kValueStep, read)} ${kQuantityInfos[this.quantity].unit}`);
    }
  }

  private async saveCsv(): Promise<void> {
    // What comes meanwhile has gaps.
    const untilS = this.record.newestS;
    await this.readHistory();
    const names = this.gauges.map(({ name }) => name).filter((name) => this.chosen.has(name));
    this.world.save(new Blob([this.record.toCsv(names, untilS)], { type: "text/csv" }), "csv");
  }

  private async savePng(): Promise<void> {
    const blob = await this.chart.toPng(`${this.world.title()} – ${kGaugeTexts.gauges}`, `${kGaugeTexts[this.quantity]} [${kQuantityInfos[this.quantity].unit}]`);
    if (blob) this.world.save(blob, "png");
    else this.world.fail(kGaugeTexts.pictureFailed(kGaugeTexts.noPicture));
  }
}

function reasonOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
