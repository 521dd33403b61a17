// A game as the server counts it, as plain data that survives postMessage.
import { GameKind, GamePhase, type Game } from "../gen/spindrift/v1/wire_pb";
import { malformed, type Malformed } from "./malformed";
import { teamName, type TeamName } from "./people";

export interface RacerInfo {
  personId: number;
  /** Done. */
  lapsCount: number;
  /** Index of the mark to round next. */
  nextMark: number;
  /** 0: none yet. */
  lapBestS: number;
  /** After the beginning; 0: on the way. */
  finishedS: number;
}

export interface GameInfo {
  kind: "race" | "ball";
  phase: "countdown" | "running" | "over";
  /** Simulation time. */
  beginsS: number;
  /** Simulation time of the decision; 0: none yet. */
  endsS: number;
  /** To win. */
  lapsCount: number;
  goalsCount: number;
  /** Best first. */
  racers: RacerInfo[];
  redGoalsCount: number;
  blueGoalsCount: number;
  /** 0: nobody yet. */
  winnerPersonId: number;
  winnerTeam: TeamName | undefined;
  ballFloaterId: number;
}

const kPhases: Partial<Record<GamePhase, GameInfo["phase"]>> = { [GamePhase.COUNTDOWN]: "countdown", [GamePhase.RUNNING]: "running", [GamePhase.OVER]: "over" };

/** `game` undefined: no game, or one of a kind that this client does not know. */
export function readGame(game: Game): { game: GameInfo | undefined } | Malformed {
  const { beginsS, endsS, lapsCount, goalsCount, redGoalsCount, blueGoalsCount, winnerPersonId, winnerTeam, ballFloaterId } = game;
  const kind = game.kind === GameKind.RACE ? "race" : game.kind === GameKind.BALL ? "ball" : undefined;
  const phase = kPhases[game.phase];
  if (!kind || !phase) return { game: undefined };
  const racers = game.racers.map(({ personId, lapsCount, nextMark, lapBestS, finishedS }) => ({ personId, lapsCount, nextMark, lapBestS, finishedS }));
  if (![beginsS, endsS, ...racers.flatMap(({ lapBestS, finishedS }) => [lapBestS, finishedS])].every(Number.isFinite)) return malformed("game: a time is not finite");
  return { game: { kind, phase, beginsS, endsS, lapsCount, goalsCount, racers, redGoalsCount, blueGoalsCount, winnerPersonId, winnerTeam: teamName(winnerTeam), ballFloaterId } };
}
