// What the projector shows of people and games: who is in, the order of a race, the score, a countdown, the result.
import type { PersonInfo } from "../../client/codec/people";
import { make, setText } from "../ui/dom";
import { clockText, countdownText, gameHeadline, GoalNews, kTeamColors, raceRows, type RaceRow } from "../ui/game_texts";
import type { LessonState } from "../ui/lesson_state";
import { kClassTexts } from "../ui/class_texts";
import { kTexts } from "../ui/texts";

/** More people, and rows of a race, are only counted. */
const kPeopleMax = 44;
const kRowsMax = 10;

/** People who play: neither operators, who steer the lesson, nor the page that shows them. */
export function playersOf({ people, ownId }: LessonState): PersonInfo[] {
  return people.filter(({ personId, role, away }) => role === "player" && !away && personId !== ownId);
}

export class Boards {
  readonly element = make("div", { class: "boards", role: "region", "aria-label": kClassTexts.title });
  private readonly headline = make("p", { class: "board-headline glass", "data-testid": "board-headline", role: "status", hidden: "" });
  private readonly score = make("p", { class: "board-score", "data-testid": "board-score", hidden: "" });
  private readonly count = make("p", { class: "board-count", "data-testid": "board-count", "aria-hidden": "true" });
  private readonly frozen = make("p", { class: "board-frozen glass", "data-testid": "board-frozen", role: "status", hidden: "" }, [kClassTexts.padsPaused]);
  private readonly race = make("table", { class: "board-race glass", "data-testid": "board-race", hidden: "" });
  private readonly people = make("ul", { class: "board-people glass", "data-testid": "board-people", "aria-label": kTexts.page.peopleList, hidden: "" });
  /** The order of a race, or everybody's names, at the right edge of the water. */
  readonly side = make("div", { class: "board-side" }, [this.race, this.people]);
  /** Changes ten times per second, which no screen reader has to say. */
  private readonly clock = make("span", { "aria-hidden": "true" });
  private readonly headlineText = make("span");
  private readonly news = new GoalNews();

  constructor(private readonly lessons: LessonState) {
    this.headline.append(this.headlineText, this.clock);
    this.element.append(make("div", { class: "board-top" }, [this.headline, this.score, this.frozen]), this.count, this.side);
    lessons.watch(() => this.refresh());
  }

  /** Called for each picture. */
  update(simTimeS: number): void {
    const { game, people } = this.lessons;
    this.news.take(game, simTimeS);
    const team = this.news.teamAt(simTimeS);
    if (game) setText(this.headlineText, team ? kTexts.goalFor(team) : gameHeadline(game, people));
    this.headline.classList.toggle("over", game?.phase === "over" || team !== undefined);
    this.headline.style.borderColor = team ? kTeamColors[team] : "";
    setText(this.count, game ? countdownText(game, simTimeS) : "");
    setText(this.clock, game ? clockText(game, simTimeS) : "");
  }

  private refresh(): void {
    const { game, people, lesson } = this.lessons;
    this.frozen.hidden = !lesson.frozen;
    this.headline.hidden = !game;
    this.score.hidden = game?.kind !== "ball";
    if (game?.kind === "ball") {
      const [red, blue] = [make("b", {}, [String(game.redGoalsCount)]), make("b", {}, [String(game.blueGoalsCount)])];
      red.style.background = kTeamColors.red;
      blue.style.background = kTeamColors.blue;
      this.score.replaceChildren(red, " : ", blue);
    }
    const rows = game?.kind === "race" ? raceRows(game, people) : [];
    this.race.hidden = rows.length === 0;
    this.race.replaceChildren(...rows.slice(0, kRowsMax).map(rowOf), ...(rows.length > kRowsMax ? [make("tr", {}, [make("td", { colspan: "4" }, [kClassTexts.andMore(rows.length - kRowsMax)])])] : []));
    this.showPeople(rows.length > 0);
  }

  /** `isRace`: the order has all names already. */
  private showPeople(isRace: boolean): void {
    const { lesson } = this.lessons;
    const players = playersOf(this.lessons);
    this.people.hidden = isRace || players.length === 0;
    const sorted = lesson.teams ? [...players].sort((a, b) => (a.team ?? "").localeCompare(b.team ?? "")) : players;
    this.people.replaceChildren(...sorted.slice(0, kPeopleMax).map(personItem), ...(players.length > kPeopleMax ? [make("li", {}, [kClassTexts.andMore(players.length - kPeopleMax)])] : []));
    this.people.classList.toggle("many", players.length > 14);
  }
}

function swatch(color: string, team: PersonInfo["team"]): HTMLElement {
  const element = make("i", { "aria-hidden": "true" });
  element.style.background = color;
  if (team) element.style.boxShadow = `0 0 0 3px ${kTeamColors[team]}`;
  return element;
}

function personItem({ name, color, team, muted }: PersonInfo): HTMLElement {
  return make("li", muted ? { class: "muted" } : {}, [swatch(color, team), make("span", {}, [name])]);
}

function rowOf({ place, name, color, team, progress, best }: RaceRow): HTMLElement {
  return make("tr", {}, [make("td", {}, [String(place)]), make("td", {}, [swatch(color, team), make("span", {}, [name])]), make("td", {}, [progress]), make("td", {}, [best])]);
}
