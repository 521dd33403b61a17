// The chart of gauges, drawn by uPlot: one line per gauge over simulation time, with a cursor that reads values.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

import { make } from "../ui/dom";
import type { Column } from "./gauge_record";

export interface Line {
  label: string;
  /** A CSS colour. */
  color: string;
}

const kInk = "#c9dde6";
const kGrid = "rgba(255, 255, 255, 0.1)";
const kFont = "12px system-ui, sans-serif";
const kPaper = "#0b2a3d";
/** Space round the lines in the picture, and the height of its title and of a row of names [px]. */
const kMarginPx = 12;
const kRowPx = 22;
/** Least range of the values: a rest level is a level line. */
const kLeastRange = 0.002;

export class GaugeChart {
  /** Where the cursor is: the index of a time; undefined while it is not over the chart. */
  cursorAt: number | undefined;
  private readonly plot: uPlot;
  private lines: readonly Line[] = [];

  /** `moved`: the cursor is over another time. `timeLabel`: of the horizontal axis. */
  constructor(
    private readonly place: HTMLElement,
    private readonly timeLabel: string,
    moved: () => void,
  ) {
    const axis = { stroke: kInk, font: kFont, grid: { stroke: kGrid, width: 1 }, ticks: { stroke: kGrid, width: 1, size: 4 } };
    this.plot = new uPlot(
      {
        ...this.size(),
        legend: { show: false },
        cursor: { y: false, drag: { setScale: false, x: false, y: false } },
        scales: { x: { time: false }, y: { range: (_, low, high) => rangeOf(low, high) } },
        axes: [
          { ...axis, size: 26, space: 56, values: (_, values) => values.map((valueS) => `${valueS} s`) },
          { ...axis, size: 52, space: 26, values: (_, values) => values.map((value) => String(Number(value.toPrecision(4)))) },
        ],
        series: [{}],
        hooks: {
          setCursor: [
            ({ cursor: { idx } }) => {
              this.cursorAt = idx ?? undefined;
              moved();
            },
          ],
        },
      },
      [[]],
      place,
    );
    new ResizeObserver(() => this.plot.setSize(this.size())).observe(place);
    // uPlot follows mice only.
    const follow = (event: PointerEvent): void => {
      const { left, top } = this.plot.over.getBoundingClientRect();
      if (event.pointerType !== "mouse") this.plot.setCursor({ left: event.clientX - left, top: event.clientY - top });
    };
    for (const type of ["pointerdown", "pointermove"] as const) this.plot.over.addEventListener(type, follow);
  }

  /** Shows one line per column. */
  show(timesS: readonly number[], columns: readonly Column[], lines: readonly Line[]): void {
    const isOther = lines.length !== this.lines.length || lines.some(({ label, color }, n) => label !== this.lines[n]!.label || color !== this.lines[n]!.color);
    if (isOther) {
      while (this.plot.series.length > 1) this.plot.delSeries(1);
      for (const { label, color } of lines) this.plot.addSeries({ label, stroke: color, width: 1.6, spanGaps: true, points: { show: false } });
      this.lines = [...lines];
    }
    this.plot.setData([timesS as number[], ...(columns as Column[])]);
  }

  /** Returns the chart with a title, names and units, as a PNG. */
  toPng(title: string, valueLabel: string): Promise<Blob | null> {
    const { canvas } = this.plot.ctx;
    const scale = uPlot.pxRatio;
    const widthPx = canvas.width / scale + 2 * kMarginPx;
    const named = this.rowsOf(widthPx - 2 * kMarginPx);
    const headPx = kMarginPx + kRowPx * (2 + named.length);
    const heightPx = headPx + canvas.height / scale + kRowPx + kMarginPx;
    const page = make("canvas", { width: String(Math.round(scale * widthPx)), height: String(Math.round(scale * heightPx)) });
    const pen = page.getContext("2d")!;
    pen.scale(scale, scale);
    pen.fillStyle = kPaper;
    pen.fillRect(0, 0, widthPx, heightPx);
    pen.textBaseline = "top";
    const write = (text: string, xPx: number, yPx: number, color: string, font = kFont): void => {
      pen.font = font;
      pen.fillStyle = color;
      pen.fillText(text, xPx, yPx);
    };
    write(title, kMarginPx, kMarginPx, "#ffffff", `600 ${kFont}`);
    write(valueLabel, kMarginPx, kMarginPx + kRowPx, kInk);
    named.forEach((row, n) => row.forEach(({ label, color, xPx }) => write(`— ${label}`, kMarginPx + xPx, kMarginPx + kRowPx * (2 + n), color)));
    pen.drawImage(canvas, kMarginPx, headPx, canvas.width / scale, canvas.height / scale);
    pen.textAlign = "center";
    write(this.timeLabel, widthPx / 2, heightPx - kRowPx - kMarginPx / 2, kInk);
    return new Promise((done) => page.toBlob(done, "image/png"));
  }

  /** The names in rows that fit into a width. */
  private rowsOf(widthPx: number): (Line & { xPx: number })[][] {
    const { ctx } = this.plot;
    const rows: (Line & { xPx: number })[][] = [[]];
    let xPx = 0;
    ctx.save();
    ctx.font = kFont;
    for (const line of this.lines) {
      const ownPx = ctx.measureText(`— ${line.label}`).width + 1.2 * kMarginPx;
      if (xPx > 0 && xPx + ownPx > widthPx) {
        rows.push([]);
        xPx = 0;
      }
      rows.at(-1)!.push({ ...line, xPx });
      xPx += ownPx;
    }
    ctx.restore();
    return rows;
  }

  private size(): { width: number; height: number } {
    return { width: Math.max(this.place.clientWidth, 160), height: Math.max(this.place.clientHeight, 110) };
  }
}

/** With room above and below; null: there are no values. */
function rangeOf(low: number | null, high: number | null): [number, number] {
  const [from, to] = [low ?? 0, high ?? 0];
  const half = Math.max(0.56 * (to - from), kLeastRange / 2);
  const middle = (from + to) / 2;
  return [middle - half, middle + half];
}
