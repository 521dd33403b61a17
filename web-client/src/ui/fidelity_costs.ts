// What each fidelity level costs and how far off it is, as measured: the tables of server/study/README.md, sections "Trade" (printed by
// `spindrift study --suite trade`) and "With and without dispersion" (`--case dispersion`). The figures of "Trade" are from a machine
// with two cores and no GPU, measured when FINE and REFERENCE used the 9-point stencil.
import type { FidelityName } from "../codec/fidelity";

interface MeasuredLevel {
  /** Wall milliseconds per simulated second on two cores. */
  costMs: number;
  /** Of the water's height, root mean square against a run finer than REFERENCE. */
  errorPercent: number;
}

/** By the scene's name. */
const kTrade: Readonly<Record<string, Readonly<Record<FidelityName, MeasuredLevel>>>> = {
  splash: {
    draft: { costMs: 172, errorPercent: 15.3 },
    balanced: { costMs: 408, errorPercent: 14.8 },
    fine: { costMs: 2023, errorPercent: 11.1 },
    reference: { costMs: 5801, errorPercent: 11 },
  },
  breaking_wave: {
    draft: { costMs: 133, errorPercent: 14.5 },
    balanced: { costMs: 444, errorPercent: 9.16 },
    fine: { costMs: 2406, errorPercent: 7.61 },
    reference: { costMs: 10025, errorPercent: 4.77 },
  },
  boat_wake: {
    draft: { costMs: 132, errorPercent: 27.7 },
    balanced: { costMs: 316, errorPercent: 22.1 },
    fine: { costMs: 1783, errorPercent: 15.8 },
    reference: { costMs: 9325, errorPercent: 12.7 },
  },
  thesis: {
    draft: { costMs: 275, errorPercent: 6.53 },
    balanced: { costMs: 596, errorPercent: 3.98 },
    fine: { costMs: 2268, errorPercent: 2.62 },
    reference: { costMs: 8393, errorPercent: 1.24 },
  },
  dam_break: {
    draft: { costMs: 176, errorPercent: 11.2 },
    balanced: { costMs: 788, errorPercent: 6.76 },
    fine: { costMs: 5762, errorPercent: 2.77 },
    reference: { costMs: 13879, errorPercent: 1.19 },
  },
};

/** Geometric means over the five scenes above, over those of BALANCED. */
const kMeans: Readonly<Record<FidelityName, { cost: number; error: number }>> = {
  draft: { cost: 0.35, error: 1.41 },
  balanced: { cost: 1, error: 1 },
  fine: { cost: 5.31, error: 0.65 },
  reference: { cost: 18.8, error: 0.41 },
};

/** The wave alone, with dispersion: milliseconds of a tick, error of the water's height. */
const kDispersedWave: Readonly<Record<string, Readonly<Record<FidelityName, { tickMs: number; errorPercent: number }>>>> = {
  splash: {
    draft: { tickMs: 0.9, errorPercent: 4.6 },
    balanced: { tickMs: 1.8, errorPercent: 3.8 },
    fine: { tickMs: 5.8, errorPercent: 3.9 },
    reference: { tickMs: 12.3, errorPercent: 3.1 },
  },
  boat_wake: {
    draft: { tickMs: 1.1, errorPercent: 9.7 },
    balanced: { tickMs: 4.8, errorPercent: 8.5 },
    fine: { tickMs: 8.5, errorPercent: 8.0 },
    reference: { tickMs: 19.7, errorPercent: 0.7 },
  },
};

/** Cost and error of a level, short: the measured scene's own figures, or those over BALANCED for a scene that was not measured. */
export function shortCost(sceneName: string, level: FidelityName): { cost: string; error: string } {
  const measured = kTrade[sceneName]?.[level];
  if (measured) return { cost: `${secondsOf(measured)} s`, error: `${measured.errorPercent} %` };
  const { cost, error } = kMeans[level];
  return { cost: `× ${cost}`, error: `× ${error}` };
}

const secondsOf = ({ costMs }: MeasuredLevel): number => Number((costMs / 1000).toPrecision(2));

/** One sentence or two: the measured scene's own figures, or the means for a scene that was not measured. */
export function describeCost(sceneName: string, level: FidelityName): string {
  const measured = kTrade[sceneName]?.[level];
  if (!measured) {
    const { cost, error } = kMeans[level];
    if (level === "balanced") return "Balanced is what the other levels are measured against; this scene was not measured.";
    return `In the mean of five measured scenes: ${cost} times the work of balanced, ${error} times its error.`;
  }
  const share = `${secondsOf(measured)} s of two cores' time per simulated second`;
  const wave = kDispersedWave[sceneName]?.[level];
  const alone = wave ? ` The wave alone: ${wave.tickMs} ms per tick, ${wave.errorPercent} % off.` : "";
  return `Measured for this scene: ${share}, water ${measured.errorPercent} % off.${alone}`;
}
