import { describe, expect, it } from "vitest";

import { length } from "../src/ui/numbers";
import { kSentenceEveryS, WaterWords, type WaterSight } from "../src/ui/water_words";

const kCalm: WaterSight = { trouble: undefined, isPaused: false, heightM: 0, sideM: 10, stormRatio: 0, hands: [] };

/** Sentences of a sight per second, with their times. */
function said(sights: (second: number) => Partial<WaterSight>, forS: number): [number, string][] {
  const words = new WaterWords();
  return Array.from({ length: forS }, (_, second): [number, string | undefined] => [second, words.take({ ...kCalm, ...sights(second) }, second)]).filter((each): each is [number, string] => each[1] !== undefined);
}

describe("the water in words", () => {
  it("says nothing again while nothing changes", () => {
    expect(said(() => ({}), 100)).toEqual([[0, "The water is calm."]]);
    expect(said((s) => ({ heightM: 0.5 + 0.1 * Math.sin(s) }), 100)).toHaveLength(1);
  });

  it("says at most one sentence in ten seconds, whatever happens", () => {
    const all = said((s) => ({ isPaused: s % 3 === 0, heightM: s % 7, stormRatio: (s % 5) / 4, hands: [{ name: `P${s}`, side: "left" }], trouble: s % 11 === 0 ? "connecting" : undefined }), 600);
    expect(all.length).toBeGreaterThan(20);
    const gaps = all.slice(1).map(([at], n) => at - all[n]![0]);
    expect(Math.min(...gaps)).toBeGreaterThanOrEqual(kSentenceEveryS);
  });

  it("tells of waves, storm, people, pause and connection, the most important first", () => {
    const all = said((s) => (s < 10 ? {} : s < 60 ? { heightM: 0.35, stormRatio: 0.8, isPaused: s >= 40, hands: s < 40 ? [{ name: "Ada", side: "left" as const }] : [] } : { trouble: "retrying in 2 s" }), 80);
    expect(all.map(([, text]) => text)).toEqual([
      "The water is calm.", "A strong storm blows.", "Ada draws in the water on the left.", "Waves of about 35 cm from trough to crest.", "The water is paused.", "No connection to the water: retrying in 2 s",
    ]);
  });

  it("has no sentence for what is over before its turn", () => {
    expect(said((s) => ({ isPaused: s > 2 && s < 6 }), 30).map(([, text]) => text)).toEqual(["The water is calm."]);
  });

  it("rounds lengths as people do", () => {
    expect([0.0084, 0.034, 0.347, 1.234, 12.3].map(length)).toEqual(["8 mm", "3 cm", "35 cm", "1.2 m", "12 m"]);
  });
});
