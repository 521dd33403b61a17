// The controls of the page under a gamepad: the D-pad goes through them and moves sliders, A presses one, B returns to the water.

const kControls = "button, input, select, summary, a[href]";
/** So many presses take a slider from end to end. */
const kSliderPresses = 20;

export class PanelCursor {
  private chosen: HTMLElement | undefined;

  /** True while a control is chosen and has the focus: a click elsewhere ends it. */
  get isActive(): boolean {
    return this.chosen !== undefined && this.chosen === document.activeElement;
  }

  /** Goes to the next control or the one before; from the last one on, and before the first, to the water. */
  move(by: 1 | -1): void {
    const controls = [...document.querySelectorAll<HTMLElement>(kControls)].filter(isUsable);
    const at = this.isActive ? controls.indexOf(this.chosen!) : by > 0 ? -1 : controls.length;
    this.leave();
    this.chosen = controls[at + by];
    if (!this.chosen) return;
    this.chosen.dataset.chosen = "";
    this.chosen.focus();
  }

  /** Moves a slider by a step, chooses the next entry of a list; elsewhere as move(). */
  change(by: 1 | -1): void {
    const { chosen } = this;
    const before = chosen instanceof HTMLInputElement || chosen instanceof HTMLSelectElement ? chosen.value : "";
    if (chosen instanceof HTMLInputElement && chosen.type === "range") {
      const steps = (Number(chosen.max) - Number(chosen.min)) / Number(chosen.step) / kSliderPresses;
      if (by > 0) chosen.stepUp(Math.max(Math.round(steps), 1));
      else chosen.stepDown(Math.max(Math.round(steps), 1));
    } else if (chosen instanceof HTMLSelectElement) {
      chosen.selectedIndex = Math.min(Math.max(chosen.selectedIndex + by, 0), chosen.length - 1);
    } else {
      return this.move(by);
    }
    if (chosen.value === before) return;
    for (const type of ["input", "change"]) chosen.dispatchEvent(new Event(type, { bubbles: true }));
  }

  press(): void {
    this.chosen?.click();
  }

  leave(): void {
    if (!this.chosen) return;
    delete this.chosen.dataset.chosen;
    this.chosen.blur();
    this.chosen = undefined;
  }
}

function isUsable(control: HTMLElement): boolean {
  return control.tabIndex >= 0 && !control.matches(":disabled") && (control.checkVisibility?.({ visibilityProperty: true }) ?? control.offsetParent !== null);
}
