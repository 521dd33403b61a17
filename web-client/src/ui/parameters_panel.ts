// The scene's parameters as sliders, built from the greeting.
import type { ParameterInfo } from "../../client/codec/greeting";
import type { CommandAction } from "../../client/session/events";
import { kPageTime } from "./latest_sender";
import { SliderModel } from "./slider_model";
import { SliderRow } from "./slider_row";

/** True if both lists give the same sliders, whatever their values. */
function haveSameRows(a: readonly ParameterInfo[], b: readonly ParameterInfo[]): boolean {
  return a.length === b.length && a.every((one, i) => (["path", "label", "unit", "min", "max", "step", "help"] as const).every((key) => one[key] === b[i]![key]));
}

export class ParametersPanel {
  private models = new Map<string, SliderModel>();
  private shown: readonly ParameterInfo[] = [];

  constructor(
    private readonly root: HTMLElement,
    private readonly send: (action: CommandAction) => number,
    /** Parameters that are shown in an element of their own, by path. */
    private readonly featured: Readonly<Record<string, HTMLElement>> = {},
  ) {}

  enter(parameters: ParameterInfo[]): void {
    // A slider that is being moved stays in the hand when only the room's fidelity changed.
    if (haveSameRows(this.shown, parameters)) return parameters.forEach(({ path, value }) => this.setServerValue(path, value));
    this.shown = parameters;
    for (const model of this.models.values()) model.dispose();
    this.models = new Map();
    this.root.replaceChildren();
    for (const root of Object.values(this.featured)) root.replaceChildren();
    for (const info of parameters) {
      const { path } = info;
      const row: SliderRow = new SliderRow(path, info, info.value, (value) => model.input(value));
      const model: SliderModel = new SliderModel(info.value, {
        send: (value) => this.send({ case: "setParameter", value: { path, value } }),
        ...kPageTime,
        changed: () => row.show(model.shownValue, model.error),
      });
      this.models.set(path, model);
      (this.featured[path] ?? this.root).append(row.element);
    }
  }

  /** True if there are parameters besides the featured ones. */
  get hasRows(): boolean {
    return this.root.childElementCount > 0;
  }

  ack(commandId: number): void {
    for (const model of this.models.values()) model.ack(commandId);
  }

  reject(commandId: number, message: string): void {
    for (const model of this.models.values()) model.reject(commandId, message);
  }

  setServerValue(path: string, value: number): void {
    this.models.get(path)?.setServerValue(value);
  }
}
