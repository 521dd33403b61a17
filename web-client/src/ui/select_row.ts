// One labelled drop-down list.
import { make, setText } from "./dom";

export interface Choice {
  value: string;
  label: string;
}

export class SelectRow {
  readonly element: HTMLElement;
  private readonly select: HTMLSelectElement;

  constructor(id: string, { label, help }: { label: string; help: string }, chosen: (value: string) => void) {
    this.select = make("select", { id, "data-testid": id });
    this.element = make("div", { class: "select", title: help }, [make("label", { for: id }, [label]), this.select]);
    this.select.addEventListener("change", () => chosen(this.select.value));
  }

  setChoices(choices: readonly Choice[], value: string): void {
    const same = choices.length === this.select.options.length && choices.every((choice, i) => this.select.options[i]!.value === choice.value);
    // Replacing the options would close a list that the user has open.
    if (!same) this.select.replaceChildren(...choices.map((choice) => make("option", { value: choice.value }, [choice.label])));
    else choices.forEach((choice, i) => setText(this.select.options[i]!, choice.label));
    this.select.value = value;
  }

  get value(): string {
    return this.select.value;
  }

  set value(value: string) {
    this.select.value = value;
  }

  set disabled(disabled: boolean) {
    this.select.disabled = disabled;
  }
}
