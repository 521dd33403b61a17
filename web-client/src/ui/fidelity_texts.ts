// What each fidelity level costs and how far off it is, in words.
import type { FidelityLevelInfo } from "../../client/codec/fidelity";
import { plain } from "./numbers";
import { kTexts } from "./texts";

const inTwoDigits = (value: number): string => plain(Number(value.toPrecision(2)));

const costText = ({ costMsPerS }: FidelityLevelInfo): string =>
  costMsPerS >= 1000 ? `${inTwoDigits(costMsPerS / 1000)} s` : `${inTwoDigits(costMsPerS)} ms`;

const errorText = (ratio: number): string => `${inTwoDigits(100 * ratio)} %`;

/** One line; empty for a level of which the server says nothing. */
export function describeLevel(level: FidelityLevelInfo | undefined): string {
  if (!level) return "";
  const { name, errorRatio, measuredOn } = level;
  if (errorRatio === undefined) return kTexts.levelCost(kTexts.fidelities[name], costText(level));
  return kTexts.levelCostAndError(kTexts.fidelities[name], costText(level), errorText(errorRatio), measuredOn);
}

/** Cells of a table, the head first. */
export function levelTable(levels: readonly FidelityLevelInfo[]): string[][] {
  const rows = levels.map((level) => [kTexts.fidelities[level.name], costText(level), level.errorRatio === undefined ? "-" : errorText(level.errorRatio)]);
  return [kTexts.levelHead, ...rows];
}
