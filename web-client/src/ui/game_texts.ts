// A game in words: countdown, order of a race, score, result. Pure.
import type { GameInfo, RacerInfo } from "../../client/codec/game";
import type { PersonInfo, TeamName } from "../../client/codec/people";
import { fixed } from "./numbers";
import { kTexts } from "./texts";

/** "Go!" is shown so long after the beginning. */
const kGoS = 1.5;

export const kTeamColors: Record<TeamName, string> = { red: "#f2545b", blue: "#4d9bff" };

type Person = Pick<PersonInfo, "personId" | "name" | "color" | "team">;

export interface RaceRow {
  place: number;
  personId: number;
  name: string;
  color: string;
  team: TeamName | undefined;
  /** Finish time, or the lap that the boat is in. */
  progress: string;
  /** Best lap; empty: none yet. */
  best: string;
}

/** Minutes and seconds with tenths, such as 1:03.4. */
export function raceTime(seconds: number): string {
  const tenths = Math.round(10 * Math.max(seconds, 0));
  const minutes = Math.floor(tenths / 600);
  const rest = fixed((tenths % 600) / 10, 1);
  return `${minutes}:${rest.padStart(4, "0")}`;
}

function progressOf(racer: RacerInfo, game: GameInfo): string {
  if (racer.finishedS > 0) return raceTime(racer.finishedS);
  if (game.phase === "over") return "–";
  return kTexts.lapOf(Math.min(racer.lapsCount + 1, game.lapsCount), game.lapsCount);
}

/** The race, best first. People who have left have no name. */
export function raceRows(game: GameInfo, people: readonly Person[]): RaceRow[] {
  return game.racers.map((racer, n) => {
    const person = people.find(({ personId }) => personId === racer.personId);
    return {
      place: n + 1,
      personId: racer.personId,
      name: person?.name ?? kTexts.left,
      color: person?.color ?? "#8fa3ad",
      team: person?.team,
      progress: progressOf(racer, game),
      best: racer.lapBestS > 0 ? raceTime(racer.lapBestS) : "",
    };
  });
}

/** Returns the number of a countdown, "Go!" just after it, and otherwise nothing. `simTimeS`: the newest time of the simulation. */
export function countdownText(game: GameInfo, simTimeS: number): string {
  const leftS = game.beginsS - simTimeS;
  if (game.phase === "countdown") return leftS > 0 ? String(Math.ceil(leftS)) : kTexts.go;
  return game.phase === "running" && -leftS >= 0 && -leftS < kGoS ? kTexts.go : "";
}

/** What a game is about, or how it ended. */
export function gameHeadline(game: GameInfo, people: readonly Person[]): string {
  const { kind, phase, lapsCount, goalsCount, winnerTeam } = game;
  if (phase === "over") return resultText(game, people);
  if (kind === "race") return kTexts.race(lapsCount);
  return winnerTeam === undefined ? kTexts.ballTo(goalsCount) : resultText(game, people);
}

const kOtherTeam: Record<TeamName, TeamName> = { red: "blue", blue: "red" };

/** What a person of a team has to do in a game now; undefined: there is nothing to do. */
export function taskText(game: GameInfo, ownId: number, team: TeamName | undefined): string | undefined {
  if (game.phase === "over" || game.winnerTeam !== undefined) return undefined;
  if (game.kind === "ball") return team && kTexts.ballTask(team, kOtherTeam[team]);
  const mark = nextMarkOf(game, ownId);
  return mark === undefined ? undefined : kTexts.buoyTask(mark + 1);
}

/** Returns the goal that a team has to push the ball into; undefined outside of a ball game. */
export function goalTeamOf(game: GameInfo | undefined, team: TeamName | undefined): TeamName | undefined {
  return game?.kind === "ball" && game.phase !== "over" && team ? kOtherTeam[team] : undefined;
}

/** A goal is told for so long [s]. */
const kGoalS = 4;

/** Remembers who has scored last, for a line that is shown for a while. */
export class GoalNews {
  private before: GameInfo | undefined;
  private team: TeamName | undefined;
  private untilS = 0;

  /** Call it with every state of the game. */
  take(game: GameInfo | undefined, nowS: number): void {
    const { before } = this;
    this.before = game;
    if (game?.kind !== "ball" || before?.kind !== "ball" || before.beginsS !== game.beginsS) return void (this.team = undefined);
    const team = game.redGoalsCount > before.redGoalsCount ? "red" : game.blueGoalsCount > before.blueGoalsCount ? "blue" : undefined;
    if (!team) return;
    this.team = team;
    this.untilS = nowS + kGoalS;
  }

  /** Returns the team whose goal is told now; undefined: none, or the game is decided, which the result tells. */
  teamAt(nowS: number): TeamName | undefined {
    return nowS < this.untilS && this.before?.phase !== "over" ? this.team : undefined;
  }
}

function resultText({ kind, winnerPersonId, winnerTeam, racers, redGoalsCount, blueGoalsCount }: GameInfo, people: readonly Person[]): string {
  if (kind === "ball") return winnerTeam ? kTexts.teamWins(winnerTeam, Math.max(redGoalsCount, blueGoalsCount), Math.min(redGoalsCount, blueGoalsCount)) : kTexts.drawn;
  const winner = people.find(({ personId }) => personId === winnerPersonId);
  if (!winner) return winnerPersonId === 0 ? kTexts.raceEnded : kTexts.winnerLeft;
  const finishedS = racers.find(({ personId }) => personId === winnerPersonId)?.finishedS ?? 0;
  return kTexts.wins(winner.name, winnerTeam, finishedS > 0 ? raceTime(finishedS) : undefined);
}

/** Time since the beginning, or of the whole game; empty before. */
export function clockText({ phase, beginsS, endsS }: GameInfo, simTimeS: number): string {
  if (phase === "countdown") return "";
  return raceTime((endsS > 0 ? endsS : simTimeS) - beginsS);
}

/** One person's race in a line, such as "3rd of 12, lap 1 of 2"; undefined for who is not in it. */
export function standingText(game: GameInfo, ownId: number): string | undefined {
  if (game.kind !== "race") return undefined;
  const at = game.racers.findIndex(({ personId }) => personId === ownId);
  const racer = game.racers[at];
  if (!racer || game.phase === "countdown") return undefined;
  const count = game.racers.length;
  return racer.finishedS > 0 ? kTexts.finished(at + 1, count, raceTime(racer.finishedS)) : kTexts.standing(at + 1, count, progressOf(racer, game));
}

/** Returns the mark that this person's boat has to round next; undefined outside of a race and after the finish. */
export function nextMarkOf(game: GameInfo | undefined, personId: number): number | undefined {
  if (game?.kind !== "race" || game.phase === "over") return undefined;
  const racer = game.racers.find((each) => each.personId === personId);
  return racer && racer.finishedS === 0 ? racer.nextMark : undefined;
}
