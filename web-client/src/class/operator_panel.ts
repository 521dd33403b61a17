// The operator's controls of a lesson: who may do what, teams, games, and order in the water.
import "./class.css";
import type { GreetingInfo } from "../../client/codec/greeting";
import { kLessonToolNames, wireLesson, type LessonInfo, type LessonTool } from "../../client/codec/lesson";
import { wireTeam, type PersonInfo, type TeamName } from "../../client/codec/people";
import { kLessonRanges, kStartGameRanges } from "../../client/gen/ranges";
import { GameKind } from "../../client/gen/spindrift/v1/wire_pb";
import type { CommandAction } from "../../client/session/events";
import { make, setText } from "../ui/dom";
import { fieldRange } from "../ui/effect_limits";
import { kTeamColors } from "../ui/game_texts";
import { kPageTime, LatestSender } from "../ui/latest_sender";
import type { LessonState } from "../ui/lesson_state";
import { SliderRow } from "../ui/slider_row";
import { playersOf } from "./boards";
import { kClassTexts } from "../ui/class_texts";
import { kTexts } from "../ui/texts";

/** At most so often while the slider moves. */
const kForceEveryMs = 250;
/** A second press within this time confirms. */
const kConfirmMs = 4000;
/** The next team when a person's team is pressed. */
const kNextTeam: Record<TeamName | "none", TeamName | undefined> = { none: "red", red: "blue", blue: undefined };

function button(testId: string, label: string, pressed: () => void): HTMLButtonElement {
  const element = make("button", { type: "button", "data-testid": testId }, [label]);
  element.addEventListener("click", pressed);
  return element;
}

/** A button that asks for a second press. */
function confirmed(testId: string, label: string, question: string, pressed: () => void): HTMLButtonElement {
  let timer: number | undefined;
  const calm = (): void => {
    window.clearTimeout(timer);
    timer = undefined;
    setText(element, label);
  };
  const element = button(testId, label, () => {
    if (timer !== undefined) {
      calm();
      return pressed();
    }
    setText(element, question);
    timer = window.setTimeout(calm, kConfirmMs);
  });
  return element;
}

export class OperatorPanel {
  readonly element: HTMLDetailsElement;
  private readonly freeze = button("lesson-freeze", kClassTexts.pausePads, () => this.change({ frozen: !this.lessons.lesson.frozen }));
  private readonly teams = button("lesson-teams", kClassTexts.teams, () => this.change({ teams: !this.lessons.lesson.teams }));
  private readonly tools = new Map<LessonTool, HTMLButtonElement>();
  private readonly force: SliderRow;
  private readonly forces: LatestSender<number>;
  private readonly clear = button("lesson-clear", kClassTexts.clear, () => this.send({ case: "removeFloater", value: { all: true } }, kTexts.commands.removeObjects));
  private readonly race: HTMLElement;
  private readonly ball: HTMLElement;
  private readonly end = button("game-end", kClassTexts.endGame, () => this.send({ case: "endGame", value: {} }, kTexts.commands.endGame));
  private readonly noGames = make("p", { class: "hint" }, [kClassTexts.noGames]);
  private readonly people = make("ul", { class: "lesson-people", "data-testid": "lesson-people", "aria-label": kClassTexts.whoPlays });
  private readonly nobody = make("p", { class: "hint" }, [kClassTexts.nobody]);
  private lapsCount: number;
  private goalsCount: number;

  constructor(
    private readonly lessons: LessonState,
    private readonly greeting: () => GreetingInfo | undefined,
    private readonly send: (action: CommandAction, label: string) => number,
  ) {
    for (const tool of kLessonToolNames) this.tools.set(tool, button(`lesson-tool-${tool}`, kTexts.lessonTools[tool], () => this.toggle(tool)));
    this.forces = new LatestSender((forceRatio) => this.change({ forceRatio }), kPageTime, kForceEveryMs);
    const percent = { ...fieldRange(kLessonRanges.forceRatio), ...kClassTexts.force, describe: (ratio: number) => `${Math.round(100 * ratio)} %` };
    this.force = new SliderRow("lesson-force", percent, 1, (ratio) => this.forces.offer(ratio));
    const laps = fieldRange(kStartGameRanges.lapsCount);
    const goals = fieldRange(kStartGameRanges.goalsCount);
    this.lapsCount = laps.default;
    this.goalsCount = goals.default;
    const lapsRow = new SliderRow("game-laps", { ...laps, ...kClassTexts.laps }, laps.default, (count) => (this.lapsCount = count));
    const goalsRow = new SliderRow("game-goals", { ...goals, ...kClassTexts.goals }, goals.default, (count) => (this.goalsCount = count));
    this.race = make("div", {}, [lapsRow.element, button("game-race", kClassTexts.startRace, () => this.send({ case: "startGame", value: { kind: GameKind.RACE, lapsCount: this.lapsCount } }, kTexts.commands.race))]);
    this.ball = make("div", {}, [goalsRow.element, button("game-ball", kClassTexts.startBall, () => this.startBall())]);
    const reset = confirmed("lesson-reset", kClassTexts.reset, kClassTexts.really, () => this.send({ case: "reset", value: {} }, kTexts.commands.reset));
    const group = (name: string, children: Node[]): HTMLElement => make("section", { class: "lesson-group", "aria-label": name }, [make("h2", {}, [name]), ...children]);
    this.element = make("details", { id: "class-box", "data-testid": "class-box" }, [
      make("summary", {}, [kClassTexts.title]),
      make("div", { class: "buttons" }, [this.freeze, this.teams]),
      group(kClassTexts.toolsGroup, [make("div", { class: "lesson-tools" }, [...this.tools.values()]), this.force.element]),
      group(kClassTexts.gameGroup, [this.race, this.ball, this.noGames, this.end]),
      group(kClassTexts.waterGroup, [make("div", { class: "buttons" }, [this.clear, reset])]),
      group(kClassTexts.peopleGroup, [this.nobody, this.people]),
    ]);
    lessons.watch(() => this.refresh());
    this.refresh();
  }

  /** Shows what the scene has; after every greeting. */
  refresh(): void {
    const { lesson, game, role } = this.lessons;
    this.element.hidden = role !== "operator";
    setText(this.freeze, lesson.frozen ? kClassTexts.resumePads : kClassTexts.pausePads);
    this.freeze.setAttribute("aria-pressed", String(lesson.frozen));
    this.teams.setAttribute("aria-pressed", String(lesson.teams));
    for (const [tool, element] of this.tools) element.setAttribute("aria-pressed", String(lesson.tools.includes(tool)));
    if (document.activeElement?.id !== "slider-lesson-force") this.force.show(lesson.forceRatio, "");
    const course = this.greeting()?.course;
    this.race.hidden = !course?.marks.length;
    this.ball.hidden = !course?.goals;
    this.noGames.hidden = !this.race.hidden || !this.ball.hidden;
    this.end.hidden = game === undefined;
    this.clear.hidden = this.greeting()?.hasFloaters !== true;
    const players = playersOf(this.lessons);
    this.nobody.hidden = players.length > 0;
    this.showPeople(players);
  }

  /** Keeps the buttons of people who stay: one may have the focus. */
  private showPeople(players: readonly PersonInfo[]): void {
    const rows = new Map([...this.people.children].map((row) => [(row as HTMLElement).dataset["person"], row as HTMLElement]));
    this.people.replaceChildren(...players.map((person) => this.rowOf(person, rows.get(String(person.personId)))));
  }

  private rowOf(person: PersonInfo, known: HTMLElement | undefined): HTMLElement {
    const row = known ?? this.makeRow(person.personId);
    const [swatch, name, team, mute] = [...row.children] as [HTMLElement, HTMLElement, HTMLElement, HTMLElement];
    swatch.style.background = person.color;
    setText(name, person.name);
    team.hidden = !this.lessons.lesson.teams;
    setText(team, person.team ? kTexts.teams[person.team] : "–");
    team.style.borderColor = person.team ? kTeamColors[person.team] : "";
    team.setAttribute("aria-label", kClassTexts.teamOf(person.name, person.team));
    setText(mute, person.muted ? kClassTexts.unmute : kClassTexts.mute);
    mute.setAttribute("aria-pressed", String(person.muted));
    mute.setAttribute("aria-label", person.muted ? kClassTexts.unmuteName(person.name) : kClassTexts.muteName(person.name));
    return row;
  }

  private makeRow(personId: number): HTMLElement {
    const person = (): PersonInfo | undefined => this.lessons.personOf(personId);
    const team = button(`team-${personId}`, "", () => this.send({ case: "setTeam", value: { personId, team: wireTeam(kNextTeam[person()?.team ?? "none"]) } }, kTexts.commands.team));
    const mute = button(`mute-${personId}`, "", () => this.send({ case: "mutePerson", value: { personId, muted: !person()?.muted } }, kTexts.commands.mute));
    return make("li", { "data-person": String(personId) }, [make("i", { "aria-hidden": "true" }), make("span"), team, mute]);
  }

  /** A ball game is one of teams: they are dealt before it. */
  private startBall(): void {
    if (!this.lessons.lesson.teams) this.change({ teams: true });
    this.send({ case: "startGame", value: { kind: GameKind.BALL, goalsCount: this.goalsCount } }, kTexts.commands.ball);
  }

  private toggle(tool: LessonTool): void {
    const { tools } = this.lessons.lesson;
    const rest = kLessonToolNames.filter((name) => (name === tool) !== tools.includes(name));
    // No tool in the list is all of them: who wants none pauses the pads.
    if (rest.length === 0) return void this.change({ frozen: true });
    this.change({ tools: rest });
  }

  private change(change: Partial<LessonInfo>): void {
    this.send({ case: "setLesson", value: { lesson: wireLesson({ ...this.lessons.lesson, ...change }) } }, kTexts.commands.lesson);
  }
}
