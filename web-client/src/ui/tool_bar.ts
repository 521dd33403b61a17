// The row of tools at the edge of the water, the line that says what the chosen one does, and its sliders. Keys 1 to 7 choose, too. A tool
// that the lesson does not hand out says so when it is chosen.
import { byId, isTyping, make, setText } from "./dom";
import { keepChoice, keptChoice } from "./kept";
import { SliderRow } from "./slider_row";
import { kTexts } from "./texts";
import { kTools, type Tool, type ToolName, type ToolScale } from "./tools";

const kToolKey = "tool";
const kHintKey = "has-drawn";
const kHintS = 12;
const kSizeRange = { ...kTexts.toolSize, unit: "%", min: 40, max: 250, step: 5 };
const kStrengthRange = { ...kTexts.toolStrength, unit: "%", min: 20, max: 100, step: 5 };

export class ToolBar {
  private readonly hint = byId("hint");
  private readonly buttons = new Map<ToolName, HTMLButtonElement>();
  private readonly scales = new Map<ToolName, ToolScale>(kTools.map(({ name }) => [name, { sizeRatio: 1, strengthRatio: 1 }]));
  private readonly size = new SliderRow("tool-size", kSizeRange, 100, (percent) => (this.scale.sizeRatio = percent / 100));
  private readonly strength = new SliderRow("tool-strength", kStrengthRange, 100, (percent) => (this.scale.strengthRatio = percent / 100));
  private current: Tool = kTools[0]!;
  private hintTimer = 0;
  private isGreeted = false;
  private hasFloaters = false;
  private whyNot: (name: ToolName) => string | undefined = () => undefined;

  /** `bar`: where the buttons go; `rows`: the sliders. */
  constructor(
    private readonly bar: HTMLElement,
    rows: HTMLElement,
    private readonly viewTurns: () => string,
    /** Called with the tool that is chosen, or undefined while no tool can be chosen. */
    private readonly changed: (name: ToolName | undefined) => void,
  ) {
    for (const { name } of kTools) {
      const button = make("button", { type: "button", "data-testid": `tool-${name}`, class: "glass" }, [kTexts.tools[name].label]);
      button.addEventListener("click", () => this.choose(name, true));
      this.buttons.set(name, button);
      bar.append(button);
    }
    rows.append(this.size.element, this.strength.element);
    window.addEventListener("keydown", (event) => {
      const tool = kTools[Number(event.key) - 1];
      if (!tool || event.ctrlKey || event.altKey || event.metaKey || isTyping(event.target) || bar.hidden || this.buttons.get(tool.name)!.hidden) return;
      this.choose(tool.name, true);
    });
    const kept = keptChoice(kToolKey);
    this.choose(kTools.find(({ name }) => name === kept)?.name ?? "finger", false);
  }

  get tool(): Tool {
    return this.current;
  }

  get scale(): ToolScale {
    return this.scales.get(this.current.name)!;
  }

  /** `mayDraw`: there is water that this visitor may change; `hasFloaters`: and objects in it. `whyNot`: why the lesson withholds a tool. */
  setAllowed(mayDraw: boolean, isOperator: boolean, hasFloaters: boolean, whyNot: (name: ToolName) => string | undefined): void {
    this.hasFloaters = hasFloaters;
    this.whyNot = whyNot;
    this.bar.hidden = !mayDraw;
    const isAbsent = ({ isOperators, needsFloaters }: Tool): boolean => (isOperators === true && !isOperator) || (needsFloaters === true && !hasFloaters);
    for (const tool of kTools) {
      const button = this.buttons.get(tool.name)!;
      const reason = whyNot(tool.name);
      button.hidden = isAbsent(tool);
      // A disabled button could not say why.
      button.setAttribute("aria-disabled", String(reason !== undefined));
      button.title = reason ?? titleOf(tool);
    }
    const isUseless = (tool: Tool): boolean => isAbsent(tool) || whyNot(tool.name) !== undefined;
    // While all are withheld, as in a pause, the choice stays.
    const useful = kTools.find((tool) => !isUseless(tool));
    if (mayDraw && useful && isUseless(this.current)) this.choose(useful.name, false);
    this.showRows();
    if (!mayDraw) this.hint.hidden = true;
    else if (!this.isGreeted) this.greet();
  }

  /** Chooses a tool so many places further in the row, among those that may be used. */
  step(count: number): void {
    const names = kTools.map(({ name }) => name).filter((name) => !this.buttons.get(name)!.hidden && this.whyNot(name) === undefined);
    const at = names.indexOf(this.current.name);
    const next = names[(at + count + names.length) % names.length];
    if (next && !this.bar.hidden) this.choose(next, true);
  }

  /** Chooses a tool as the page begins, by its name; an unknown one is ignored. */
  begin(name: string): void {
    const tool = kTools.find((each) => each.name === name);
    if (tool) this.choose(tool.name, false);
  }

  /** The tool was used: no hint is needed any more. */
  wasUsed(): void {
    this.hint.hidden = true;
    keepChoice(kHintKey, "1");
  }

  /** Says what the tool does. */
  explain(text = this.does): void {
    setText(this.hint, text);
    this.hint.hidden = false;
    window.clearTimeout(this.hintTimer);
    this.hintTimer = window.setTimeout(() => (this.hint.hidden = true), 1000 * kHintS);
  }

  /** Shows a line that stays until it is replaced; undefined: takes it away. */
  announce(text: string | undefined): void {
    window.clearTimeout(this.hintTimer);
    setText(this.hint, text ?? "");
    this.hint.hidden = text === undefined;
  }

  private choose(name: ToolName, isByUser: boolean): void {
    const reason = isByUser ? this.whyNot(name) : undefined;
    if (reason !== undefined) return this.explain(reason);
    this.current = kTools.find((tool) => tool.name === name)!;
    for (const [each, button] of this.buttons) button.setAttribute("aria-pressed", String(each === name));
    const { sizeRatio, strengthRatio } = this.scale;
    this.size.show(100 * sizeRatio, "");
    this.strength.show(100 * strengthRatio, "");
    this.showRows();
    if (!isByUser) return;
    keepChoice(kToolKey, name);
    this.explain();
  }

  private get does(): string {
    const { does } = kTexts.tools[this.current.name];
    if (this.current.name !== "finger" || !this.hasFloaters) return does;
    const isTouch = window.matchMedia("(pointer: coarse)").matches;
    return [does, isTouch ? kTexts.movesObjectsByTouch : kTexts.movesObjectsByMouse].join(" ");
  }

  private showRows(): void {
    const isShown = !this.bar.hidden;
    this.size.element.hidden = !isShown;
    this.strength.element.hidden = !isShown || this.current.name === "float";
    this.changed(isShown ? this.current.name : undefined);
  }

  /** On the first visit. */
  private greet(): void {
    this.isGreeted = true;
    if (keptChoice(kHintKey) === undefined) this.explain(`${this.does} ${this.viewTurns()}`);
  }
}

function titleOf(tool: Tool): string {
  return kTexts.toolKey(kTexts.tools[tool.name].does, kTools.indexOf(tool) + 1);
}
