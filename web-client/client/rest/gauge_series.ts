// Asks the server for what a gauge measured at the last ticks.
import { kSessionTexts } from "../session/texts";
import { ask } from "./rooms";

/** Values of one gauge, oldest first; lists of one length. */
export interface GaugeSeries {
  /** Simulation time since the start of the scene. */
  timeS: number[];
  elevationM: number[];
  velocityXMps: number[];
  velocityZMps: number[];
}

/** `base`: address of the server with a slash at its end. Throws an Error with a line for people. */
export async function requestSeries(room: string, gauge: string, token: string, base = ""): Promise<GaugeSeries> {
  return readSeries((await ask(`${base}api/v1/rooms/${encodeURIComponent(room)}/gauges/${encodeURIComponent(gauge)}`, token)) as Record<string, unknown>);
}

/** Throws an Error if the answer is not a series. */
export function readSeries(body: Record<string, unknown>): GaugeSeries {
  const list = (name: string): number[] => {
    const values = body[name] ?? [];
    if (!Array.isArray(values) || !values.every((value) => Number.isFinite(value))) throw new Error(kSessionTexts.notNumbers(name));
    return values;
  };
  const series = { timeS: list("time_s"), elevationM: list("elevation_m"), velocityXMps: list("velocity_x_mps"), velocityZMps: list("velocity_z_mps") };
  const counts = Object.values(series).map(({ length }) => length);
  if (new Set(counts).size > 1) throw new Error(kSessionTexts.unequalLists(counts.join(", ")));
  if (series.timeS.some((timeS, n) => n > 0 && timeS <= series.timeS[n - 1]!)) throw new Error(kSessionTexts.notAscending("time_s"));
  return series;
}
