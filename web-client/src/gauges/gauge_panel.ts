// The panel with the chart of the gauges: which gauges, which quantity and how much time; values under the cursor; pause; files; and gauges of
// one's own, to place and to remove. On wide windows it lies over the water, on narrow ones it is the first part of the sheet.
import type { GaugeInfo } from "../../client/codec/scene_info";
import type { GaugeSeries } from "../../client/rest/gauge_series";
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
  /** The next tap on the water places a gauge. */
  isPlacing(): boolean;
  mayPlace(): boolean;
  /** `personId`: who has placed the gauge. */
  mayRemove(personId: number): boolean;
  isOwn(personId: number): boolean;
  nameOf(personId: number): string | undefined;
  /** Lets the next tap place a gauge, or not any longer. */
  place(): void;
  remove(gaugeId: number): void;
}

interface Key {
  element: HTMLElement;
  button: HTMLButtonElement;
  value: HTMLElement;
  /** Of a gauge that a person has placed. */
  removal: HTMLButtonElement | undefined;
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
  private readonly placeButton: HTMLButtonElement;
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
    this.placeButton = button("gauge-place", kGaugeTexts.place, kGaugeTexts.placeHelp, () => world.place());
    this.quantityRow.setChoices(kQuantities.map((value) => ({ value, label: `${kGaugeTexts[value]} [${kQuantityInfos[value].unit}]` })), this.quantity);
    this.spanRow.setChoices(kSpansS.map((spanS) => ({ value: String(spanS), label: `${spanS} s` })), String(this.spanS));
    this.keyRow.append(this.placeButton);
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
    this.refresh();
  }

  /** `isOtherWater`: what was read before does not belong to these gauges. */
  setGauges(gauges: readonly GaugeInfo[], isOtherWater: boolean): void {
    const isFirst = this.gauges.length === 0 || isOtherWater;
    if (isOtherWater) this.record.clear();
    const added = gauges.filter(({ name }) => isFirst || !this.gauges.some((before) => before.name === name));
    const chosen = isFirst ? [] : [...this.chosen].filter((name) => gauges.some((gauge) => gauge.name === name));
    const isOwn = ({ placed }: GaugeInfo): boolean => placed !== undefined && this.world.isOwn(placed.personId);
    const shown = added.filter((gauge, n) => isOwn(gauge) || n < kFirstChosen - chosen.length).map(({ name }) => name);
    this.chosen = new Set([...chosen, ...shown]);
    this.gauges = gauges;
    // One of the same name in other water may be the scene's.
    for (const name of [...this.keys.keys()]) if (isOtherWater || !gauges.some((gauge) => gauge.name === name)) this.dropKey(name);
    for (const gauge of gauges) {
      const key = this.keys.get(gauge.name) ?? this.addKey(gauge);
      key.button.style.setProperty("--line", this.lineOf(gauge.name).color);
    }
    if (isFirst) this.hold(false);
    if (this.isOpen) void this.readHistory(isOtherWater ? undefined : shown);
    this.refresh();
    this.draw();
  }

  /** Shows what this visitor may do now, and who has placed what. */
  refresh(): void {
    const { world, placeButton } = this;
    placeButton.hidden = !world.mayPlace();
    placeButton.setAttribute("aria-pressed", String(world.isPlacing()));
    setText(placeButton, world.isPlacing() ? kGaugeTexts.placing : kGaugeTexts.place);
    for (const { name, placed } of this.gauges) {
      const { button, removal } = this.keys.get(name)!;
      if (!placed || !removal) continue;
      const owner = world.nameOf(placed.personId);
      button.title = world.isOwn(placed.personId) ? kGaugeTexts.ownGauge : owner === undefined ? "" : kGaugeTexts.gaugeOf(owner);
      removal.hidden = !world.mayRemove(placed.personId);
    }
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

  private addKey({ name, placed }: GaugeInfo): Key {
    const value = make("span", { class: "gauge-value" });
    const button = make("button", { type: "button", "data-testid": `gauge-key-${name}` }, [make("i"), name, value]);
    button.addEventListener("click", () => this.toggle(name));
    const removal = placed && make("button", { type: "button", class: "gauge-remove", "data-testid": `gauge-remove-${name}`, title: kGaugeTexts.remove(name), "aria-label": kGaugeTexts.remove(name) }, ["×"]);
    removal?.addEventListener("click", () => this.world.remove(placed!.gaugeId));
    const key = { element: make("span", { class: "gauge-key" }, removal ? [button, removal] : [button]), button, value, removal };
    this.keys.set(name, key);
    this.placeButton.before(key.element);
    return key;
  }

  private dropKey(name: string): void {
    const { element } = this.keys.get(name)!;
    // Who has removed it with a key continues here.
    if (element.contains(document.activeElement)) this.placeButton.focus();
    element.remove();
    this.keys.delete(name);
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
          // It may have been removed meanwhile.
          if (this.keys.has(name)) this.world.fail(kGaugeTexts.noHistory(name, reasonOf(error)));
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
    setText(this.at, this.gauges.length === 0 ? kGaugeTexts.empty : names.length === 0 ? kGaugeTexts.none : when);
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
