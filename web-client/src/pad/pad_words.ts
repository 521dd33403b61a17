// The pad's lines: connection, place in a race, score, countdown, result, and why nothing can be done.
import type { ConnectionState } from "../../client/session/events";
import { setText } from "../ui/dom";
import { countdownText, gameHeadline, GoalNews, standingText, taskText } from "../ui/game_texts";
import { describeState } from "../ui/hud";
import type { LessonState } from "../ui/lesson_state";
import type { PadElements } from "./pad_layout";
import type { OwnPose } from "./pad_map";
import { fixed } from "../ui/numbers";
import { kPadTexts } from "../ui/pad_texts";
import { kTexts } from "../ui/texts";

/** Compass heading of a boat: +x is east, and -z north. */
export function compassText(headingRad: number): string {
  const degrees = Math.round((headingRad * 180) / Math.PI + 90);
  return `${String(((degrees % 360) + 360) % 360).padStart(3, "0")}°`;
}

export class PadWords {
  private readonly news = new GoalNews();

  constructor(
    private readonly elements: PadElements,
    private readonly lessons: LessonState,
  ) {}

  /** `reason`: why nobody, or this visitor, may do anything now. */
  refresh(state: ConnectionState, reason: string | undefined): void {
    const { elements, lessons } = this;
    const { game, ownId } = lessons;
    const isLive = state.name === "live";
    setText(elements.state, isLive ? "" : describeState(state));
    elements.retry.hidden = state.name !== "retrying" && state.name !== "refused";
    const offline = state.name === "refused" ? state.reason : state.name === "retrying" ? kPadTexts.lost : kPadTexts.connecting;
    const veil = isLive ? (lessons.role === "viewer" && lessons.ownId !== 0 ? kPadTexts.mayWatch : reason) : offline;
    setText(elements.veil, veil ?? "");
    elements.veil.hidden = veil === undefined;
    const team = lessons.me?.team;
    setText(elements.standing, (game && standingText(game, ownId)) ?? (game?.kind === "ball" ? kTexts.score(game.redGoalsCount, game.blueGoalsCount) : team ? kTexts.teamOf(team) : ""));
    elements.headline.hidden = !game;
  }

  /** Called for each picture. */
  update(simTimeS: number, pose: OwnPose | undefined): void {
    const { elements, lessons: { game, people, ownId, me } } = this;
    this.news.take(game, simTimeS);
    const team = this.news.teamAt(simTimeS);
    if (game) setText(elements.headline, team ? kTexts.goalFor(team) : (taskText(game, ownId, me?.team) ?? gameHeadline(game, people)));
    elements.headline.classList.toggle("over", game?.phase === "over" || team !== undefined);
    setText(elements.count, game ? countdownText(game, simTimeS) : "");
    setText(elements.speed, pose ? `${fixed(Math.abs(pose.speedMps), 1)} m/s` : "–");
    setText(elements.heading, pose ? compassText(pose.headingRad) : "–");
  }
}
