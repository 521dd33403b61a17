// What each fidelity level costs and how far off it is, as `spindrift-study --suite trade` measured it without a GPU.
// tests/study/write_tables.py writes the figures; `./dev study --update` measures them again.
import { type FidelityName, kFidelities } from "../codec/fidelity";
import figures from "./fidelity_costs.json";

/** Seconds of processor time per simulated second and percent of the water's height, or both over those of balanced. */
type CostAndError = readonly number[];

const kScenes: Readonly<Record<string, readonly CostAndError[]>> = figures.scenes;

/** Day (UTC) on which the figures were measured. */
export const kMeasuredOn = figures.date;

const rank = (level: FidelityName): number => kFidelities.findIndex(({ name }) => name === level);

/** Cost and error of a level, short: the measured scene's own figures, or those over BALANCED for a scene that was not measured. */
export function shortCost(sceneName: string, level: FidelityName): { cost: string; error: string } {
  const measured = kScenes[sceneName]?.[rank(level)];
  const [cost, error] = measured ?? figures.means[rank(level)]!;
  return measured ? { cost: `${cost} s`, error: `${error} %` } : { cost: `× ${cost}`, error: `× ${error}` };
}

/** One sentence or two: the measured scene's own figures, or the means for a scene that was not measured. */
export function describeCost(sceneName: string, level: FidelityName): string {
  const measured = kScenes[sceneName]?.[rank(level)];
  if (measured) {
    const [cost, error] = measured;
    return `Measured for this scene on ${kMeasuredOn}: ${cost} s of processor time per simulated second, water ${error} % off.`;
  }
  if (level === "balanced") return "Balanced is what the other levels are measured against; this scene was not measured.";
  const [cost, error] = figures.means[rank(level)]!;
  const count = Object.keys(kScenes).length;
  return `Not measured for this scene. In the mean of ${count} measured scenes (${kMeasuredOn}): ${cost} times the work of balanced, ${error} times its error.`;
}
