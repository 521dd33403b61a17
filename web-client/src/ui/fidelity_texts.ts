// What each fidelity level costs and how far off it is, in words.
import type { FidelityLevelInfo } from "../codec/fidelity";

const inTwoDigits = (value: number): number => Number(value.toPrecision(2));

const costText = ({ costMsPerS }: FidelityLevelInfo): string =>
  costMsPerS >= 1000 ? `${inTwoDigits(costMsPerS / 1000)} s` : `${inTwoDigits(costMsPerS)} ms`;

const errorText = (ratio: number): string => `${inTwoDigits(100 * ratio)} %`;

/** One line; empty for a level of which the server says nothing. */
export function describeLevel(level: FidelityLevelInfo | undefined): string {
  if (!level) return "";
  const { name, errorRatio, measuredOn } = level;
  const cost = `At ${name}, a simulated second takes this server ${costText(level)}`;
  if (errorRatio === undefined) return `${cost}. The error was not measured for this scene.`;
  return `${cost}; the height of the water is ${errorText(errorRatio)} off (measured on ${measuredOn}).`;
}

/** Cells of a table, the head first. */
export function levelTable(levels: readonly FidelityLevelInfo[]): string[][] {
  const rows = levels.map((level) => [level.name, costText(level), level.errorRatio === undefined ? "-" : errorText(level.errorRatio)]);
  return [["level", "time per second, predicted", "error"], ...rows];
}
