// One labelled slider with its value and an error line.
import { formatBy, make, setText } from "./dom";

export interface SliderRange {
  label: string;
  /** What it does, as a tooltip. */
  help?: string;
  unit: string;
  min: number;
  max: number;
  step: number;
  /** The value as text; by default with its unit. */
  describe?: (value: number) => string;
}

export class SliderRow {
  readonly element: HTMLElement;
  private readonly input: HTMLInputElement;
  private readonly output: HTMLOutputElement;
  private readonly error: HTMLElement;

  constructor(
    id: string,
    private range: SliderRange,
    value: number,
    moved: (value: number) => void,
  ) {
    this.input = make("input", { type: "range", id: `slider-${id}`, "data-testid": `slider-${id}`, "aria-describedby": `error-${id}` });
    this.output = make("output", { for: `slider-${id}` });
    this.error = make("p", { id: `error-${id}`, class: "slider-error", "data-testid": `slider-error-${id}`, role: "alert" });
    const label = make("label", { for: `slider-${id}` }, [range.label]);
    this.element = make("div", { class: "slider", ...(range.help ? { title: range.help } : {}) }, [make("div", { class: "slider-head" }, [label, this.output]), this.input, this.error]);
    this.input.addEventListener("input", () => {
      this.writeOutput(this.input.valueAsNumber);
      moved(this.input.valueAsNumber);
    });
    this.setRange(range, value);
  }

  setRange(range: SliderRange, value: number): void {
    this.range = range;
    this.input.min = String(range.min);
    this.input.max = String(range.max);
    this.input.step = String(range.step);
    this.show(value, "");
  }

  show(value: number, error: string): void {
    this.input.value = String(value);
    this.writeOutput(value);
    setText(this.error, error);
  }

  set disabled(disabled: boolean) {
    this.input.disabled = disabled;
  }

  private writeOutput(value: number): void {
    const text = this.range.describe?.(value) ?? `${formatBy(this.range.step, value)}${this.range.unit ? ` ${this.range.unit}` : ""}`;
    setText(this.output, text);
    this.input.setAttribute("aria-valuetext", text);
    const span = this.range.max - this.range.min;
    this.input.style.setProperty("--filled", `${span > 0 ? ((value - this.range.min) / span) * 100 : 0}%`);
  }
}
