// What the page knows of the readings of gauges: one list of times, and for each gauge a column per quantity with gaps where it has no
// reading. The history of a gauge comes from the server with every tick, the newest readings come about ten times per second. Pure.
import type { GaugeSeries } from "../../client/rest/gauge_series";

export const kQuantities = ["elevation", "velocityX", "velocityZ"] as const;
export type Quantity = (typeof kQuantities)[number];

interface QuantityInfo {
  unit: string;
  /** In the header of a table. */
  column: string;
  read(series: GaugeSeries): number[];
}

export const kQuantityInfos: Record<Quantity, QuantityInfo> = {
  elevation: { unit: "m", column: "elevation [m]", read: ({ elevationM }) => elevationM },
  velocityX: { unit: "m/s", column: "velocity x [m/s]", read: ({ velocityXMps }) => velocityXMps },
  velocityZ: { unit: "m/s", column: "velocity z [m/s]", read: ({ velocityZMps }) => velocityZMps },
};

/** Null: no reading at this time. */
export type Column = (number | null)[];

export interface GaugeReadingInfo {
  name: string;
  elevationM: number;
  velocityXMps: number;
  velocityZMps: number;
}

/** Times that are kept: 80 s with every tick at 60 Hz. */
export const kMostTimes = 4800;

export class GaugeRecord {
  private timesS: number[] = [];
  private readonly columns = new Map<string, Record<Quantity, Column>>();

  get newestS(): number | undefined {
    return this.timesS.at(-1);
  }

  clear(): void {
    this.timesS = [];
    this.columns.clear();
  }

  /** Adds the readings of one time. An earlier one than before means that the scene has started again: what was before is dropped ("anew"). */
  add(timeS: number, readings: readonly GaugeReadingInfo[]): "added" | "known" | "anew" {
    const { newestS } = this;
    if (timeS === newestS) return "known";
    const isAnew = newestS !== undefined && timeS < newestS;
    if (isAnew) this.clear();
    this.timesS.push(timeS);
    for (const { name, ...reading } of readings) {
      const columns = this.columnsOf(name);
      columns.elevation[this.timesS.length - 1] = reading.elevationM;
      columns.velocityX[this.timesS.length - 1] = reading.velocityXMps;
      columns.velocityZ[this.timesS.length - 1] = reading.velocityZMps;
    }
    this.fillAndTrim();
    return isAnew ? "anew" : "added";
  }

  /** Adds the history of a gauge. What is known of times later than its last one stays. `untilS`: leaves out what is later. */
  merge(name: string, series: GaugeSeries, untilS = Infinity): void {
    const own = this.columnsOf(name);
    const at = new Map(series.timeS.map((timeS, n) => [timeS, n]));
    const times = [...new Set([...this.timesS, ...series.timeS.filter((timeS) => timeS <= untilS)])].sort((a, b) => a - b);
    const before = new Map(this.timesS.map((timeS, n) => [timeS, n]));
    for (const columns of this.columns.values())
      for (const quantity of kQuantities) {
        const values = columns === own ? kQuantityInfos[quantity].read(series) : undefined;
        const old = columns[quantity];
        columns[quantity] = times.map((timeS) => values?.[at.get(timeS) ?? -1] ?? old[before.get(timeS) ?? -1] ?? null);
      }
    this.timesS = times;
    this.fillAndTrim();
  }

  /** Returns times and one column per gauge, of the last `spanS` seconds. */
  view(names: readonly string[], quantity: Quantity, spanS = Infinity): { timesS: number[]; columns: Column[] } {
    const beginS = (this.newestS ?? 0) - spanS;
    const first = this.timesS.findIndex((timeS) => timeS >= beginS);
    const from = first < 0 ? this.timesS.length : first;
    const timesS = this.timesS.slice(from);
    return { timesS, columns: names.map((name) => this.columns.get(name)?.[quantity].slice(from) ?? timesS.map(() => null)) };
  }

  /** Returns what is known of these gauges until a time as a table with units in its header. Times without any reading of them are left out. */
  toCsv(names: readonly string[], untilS = Infinity): string {
    const columns = names.flatMap((name) => kQuantities.map((quantity) => ({ head: `${name} ${kQuantityInfos[quantity].column}`, values: this.view([name], quantity).columns[0]! })));
    const rows = this.timesS.flatMap((timeS, n) => {
      const values = columns.map(({ values: all }) => all[n] ?? null);
      return timeS > untilS || values.every((value) => value === null) ? [] : [[timeS, ...values.map((value) => value ?? "")].join(",")];
    });
    return [["time [s]", ...columns.map(({ head }) => head)].join(","), ...rows, ""].join("\n");
  }

  private columnsOf(name: string): Record<Quantity, Column> {
    const known = this.columns.get(name);
    if (known) return known;
    const empty = (): Column => this.timesS.map(() => null);
    const columns = { elevation: empty(), velocityX: empty(), velocityZ: empty() };
    this.columns.set(name, columns);
    return columns;
  }

  /** All columns are as long as the times, which are bounded. */
  private fillAndTrim(): void {
    const excess = Math.max(this.timesS.length - kMostTimes, 0);
    for (const [name, columns] of this.columns) {
      for (const quantity of kQuantities) {
        const column = columns[quantity];
        while (column.length < this.timesS.length) column.push(null);
        column.splice(0, excess);
      }
      if (columns.elevation.every((value) => value === null)) this.columns.delete(name);
    }
    this.timesS.splice(0, excess);
  }
}
