import { describe, expect, it } from "vitest";

import type { GameInfo } from "../client/codec/game";
import { clockText, countdownText, gameHeadline, GoalNews, goalTeamOf, nextMarkOf, raceRows, raceTime, standingText, taskText } from "../src/ui/game_texts";
import { kTexts } from "../src/ui/texts";

const racer = (personId: number, change: object = {}) => ({ personId, lapsCount: 0, nextMark: 1, lapBestS: 0, finishedS: 0, ...change });
const race = (change: Partial<GameInfo>): GameInfo => ({
  kind: "race", phase: "running", beginsS: 10, endsS: 0, lapsCount: 2, goalsCount: 3, racers: [], redGoalsCount: 0, blueGoalsCount: 0, winnerPersonId: 0, winnerTeam: undefined, ballFloaterId: 0, ...change,
});
const people = [{ personId: 1, name: "Ada", color: "#ff0000", team: "red" as const }, { personId: 2, name: "Bo", color: "#00ff00", team: undefined }];

describe("the words of a game", () => {
  it("write times in minutes, seconds and tenths, also at a full minute", () => {
    expect([0, 5.04, 59.96, 63.4, 600, -1].map(raceTime)).toEqual(["0:00.0", "0:05.0", "1:00.0", "1:03.4", "10:00.0", "0:00.0"]);
    expect([1, 2, 3, 4, 11, 12, 13, 21, 22, 40, 111].map(kTexts.ordinal)).toEqual(["1st", "2nd", "3rd", "4th", "11th", "12th", "13th", "21st", "22nd", "40th", "111th"]);
  });

  it("count down to Go, which stays for a moment", () => {
    const counting = race({ phase: "countdown" });
    expect([4.9, 5, 9.1, 10.2].map((timeS) => countdownText(counting, timeS))).toEqual(["6", "5", "1", "Go!"]);
    expect([10, 11.4, 11.6].map((timeS) => countdownText(race({}), timeS))).toEqual(["Go!", "Go!", ""]);
    expect(countdownText(race({ phase: "over" }), 10.5)).toBe("");
  });

  it("list a race best first, with laps, best laps and finish times", () => {
    const game = race({ racers: [racer(2, { lapsCount: 2, finishedS: 71.25, lapBestS: 34.1 }), racer(1, { lapsCount: 1 }), racer(9)] });
    const rows = raceRows(game, people);
    expect(rows.map(({ place, name, progress, best }) => [place, name, progress, best])).toEqual([[1, "Bo", "1:11.3", "0:34.1"], [2, "Ada", "lap 2 of 2", ""], [3, "left", "lap 1 of 2", ""]]);
    expect(rows[1]!.team).toBe("red");
  });

  it("say who has won", () => {
    const over = race({ phase: "over", winnerPersonId: 1, winnerTeam: "red", racers: [racer(1, { finishedS: 63.4 })] });
    expect(gameHeadline(over, people)).toBe("Ada wins for red in 1:03.4");
    expect(gameHeadline(race({ phase: "over" }), people)).toBe("The race has ended");
    expect(gameHeadline(race({ phase: "over", winnerPersonId: 77 }), people)).toBe("The winner has left");
    expect(gameHeadline(race({ kind: "ball", phase: "over", redGoalsCount: 1, blueGoalsCount: 3, winnerTeam: "blue" }), people)).toBe("Blue wins 3 : 1");
    expect(gameHeadline(race({ kind: "ball" }), people)).toBe("Ball into the other goal: first to 3");
    expect(gameHeadline(race({ lapsCount: 1 }), people)).toBe("Race: 1 lap");
  });

  it("run a clock from the beginning to the decision", () => {
    expect(clockText(race({ phase: "countdown" }), 9)).toBe("");
    expect(clockText(race({}), 25.5)).toBe("0:15.5");
    expect(clockText(race({ phase: "over", endsS: 40 }), 90)).toBe("0:30.0");
  });

  it("tell a racer place, lap and next mark", () => {
    const game = race({ racers: [racer(2), racer(1, { nextMark: 3 })] });
    expect(standingText(game, 1)).toBe("2nd of 2, lap 1 of 2");
    expect(standingText(game, 5)).toBeUndefined();
    expect([nextMarkOf(game, 1), nextMarkOf(game, 5), nextMarkOf({ ...game, phase: "over" }, 1), nextMarkOf(undefined, 1)]).toEqual([3, undefined, undefined, undefined]);
    const done = race({ racers: [racer(1, { finishedS: 20, lapsCount: 2 })] });
    expect(standingText(done, 1)).toBe("Finished 1st of 1, 0:20.0");
    expect(nextMarkOf(done, 1)).toBeUndefined();
  });

  it("tell each team which goal is its own to score in, and a racer which buoy is next", () => {
    const ball = race({ kind: "ball" });
    expect([taskText(ball, 1, "red"), taskText(ball, 1, undefined)]).toEqual(["Team red: push the ball into the blue goal", undefined]);
    expect([goalTeamOf(ball, "blue"), goalTeamOf(race({}), "blue"), goalTeamOf(race({ kind: "ball", phase: "over" }), "blue")]).toEqual(["red", undefined, undefined]);
    expect(taskText(race({ racers: [racer(1)] }), 1, "red")).toBe("Steer to buoy 2, the yellow one");
    expect(taskText(race({ racers: [racer(1, { finishedS: 40 })] }), 1, "red")).toBeUndefined();
    expect(taskText(race({ kind: "ball", phase: "over" }), 1, "red")).toBeUndefined();
  });

  it("tell a goal for a while, but not those of a game that one has just joined, nor the deciding one", () => {
    const news = new GoalNews();
    news.take(race({ kind: "ball", redGoalsCount: 2 }), 20);
    expect(news.teamAt(20)).toBeUndefined();
    news.take(race({ kind: "ball", redGoalsCount: 2, blueGoalsCount: 1 }), 21);
    expect([21, 24.9, 25.1].map((atS) => news.teamAt(atS))).toEqual(["blue", "blue", undefined]);
    news.take(race({ kind: "ball", phase: "over", redGoalsCount: 3, blueGoalsCount: 1 }), 30);
    expect(news.teamAt(30)).toBeUndefined();
    news.take(race({ kind: "ball", beginsS: 60 }), 55);
    news.take(race({ kind: "ball", beginsS: 60, redGoalsCount: 1 }), 70);
    expect(news.teamAt(70)).toBe("red");
  });
});
