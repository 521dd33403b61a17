// The room's fidelity: the level, what each costs and how far off it is, and a note where the machine cannot keep up.
import { type FidelityLevelInfo, type FidelityName, kFidelities, wireFidelity } from "../../client/codec/fidelity";
import type { GreetingInfo } from "../../client/codec/greeting";
import type { DiagnosticsInfo } from "../../client/codec/parse";
import type { CommandAction } from "../../client/session/events";
import { make, setText } from "./dom";
import { describeLevel, levelTable } from "./fidelity_texts";
import { PaceWatch } from "./pace_watch";
import { SelectRow } from "./select_row";
import { kTexts } from "./texts";

export class FidelityRow {
  readonly element: HTMLElement;
  /** A note where the machine cannot keep up; empty and hidden where it can. */
  readonly pace = make("p", { class: "hint trouble", "data-testid": "pace", role: "status", hidden: "" });
  private readonly row: SelectRow;
  private readonly cost = make("p", { class: "hint", "data-testid": "fidelity-cost" });
  private readonly table = make("table", { "data-testid": "fidelity-table" });
  private readonly costs = make("details", { class: "costs" }, [make("summary", {}, [kTexts.levelCosts]), this.table]);
  private readonly watch = new PaceWatch();
  private sceneName = "";
  private level: FidelityName = "balanced";
  private levels: readonly FidelityLevelInfo[] = [];
  private speed = 1;
  private changeId = 0;

  constructor(send: (action: CommandAction, label: string) => number) {
    this.row = new SelectRow("fidelity", kTexts.fidelity, (value) => {
      const wanted = value as FidelityName;
      this.changeId = send({ case: "changeScene", value: { name: this.sceneName, fidelity: wireFidelity(wanted) } }, kTexts.commands.fidelity(kTexts.fidelities[wanted]));
      setText(this.cost, kTexts.buildingLevel(kTexts.fidelities[wanted], kTexts.fidelities[this.level]));
    });
    this.row.setChoices(
      kFidelities.map(({ name }) => ({ value: name, label: kTexts.fidelities[name] })),
      this.level,
    );
    this.element = make("div", {}, [this.row.element, this.cost, this.costs]);
  }

  enter(greeting: GreetingInfo): void {
    this.sceneName = greeting.sceneName;
    this.level = greeting.fidelity;
    this.levels = greeting.fidelityLevels;
    this.speed = greeting.speed;
    this.watch.forget();
    this.showPace("");
    // A scene that the server does not list cannot be loaded again at another level.
    this.element.hidden = !greeting.scenes.includes(greeting.sceneName);
    this.showTable();
    this.show();
  }

  setSpeed(speed: number): void {
    this.speed = speed;
  }

  set disabled(disabled: boolean) {
    this.row.disabled = disabled;
  }

  diagnostics({ realTimeFactor }: DiagnosticsInfo, nowS: number): void {
    const note = this.watch.note(realTimeFactor, this.speed, nowS);
    const advice = this.level === kFidelities[0].name ? [] : [kTexts.coarserCostsLess];
    this.showPace(note && [note, ...advice].join(" "));
  }

  /** The greeting of the new water comes before its ack. */
  ack(commandId: number): void {
    if (commandId !== this.changeId) return;
    this.changeId = 0;
    this.show();
  }

  reject(commandId: number, message: string): void {
    if (commandId !== this.changeId) return;
    this.changeId = 0;
    this.show();
    setText(this.cost, message);
  }

  get isChanging(): boolean {
    return this.changeId !== 0;
  }

  private show(): void {
    this.row.value = this.level;
    setText(this.cost, describeLevel(this.levels.find(({ name }) => name === this.level)));
  }

  private showTable(): void {
    const rows = levelTable(this.levels).map((cells, row) => make("tr", {}, cells.map((text) => make(row === 0 ? "th" : "td", {}, [text]))));
    this.table.replaceChildren(...rows);
    this.costs.hidden = this.levels.length === 0;
  }

  private showPace(text: string): void {
    setText(this.pace, text);
    this.pace.hidden = text === "";
  }
}
