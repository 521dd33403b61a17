// The stick that steers one's boat: up is ahead, sideways is the rudder; it springs back.
import { make } from "../ui/dom";
import { kPadTexts } from "../ui/pad_texts";

/** Within this share of its reach the stick does not move, so that a resting thumb stops the engine. */
const kDeadShare = 0.14;

export interface HelmSetting {
  throttleRatio: number;
  rudderRatio: number;
}

export const kMidships: HelmSetting = { throttleRatio: 0, rudderRatio: 0 };

/** Returns the setting for a thumb so far right and down of the stick's middle, in shares of its reach. Pure. */
export function stickSetting(rightShare: number, downShare: number): HelmSetting {
  const along = (share: number): number => {
    const beyond = (Math.min(Math.abs(share), 1) - kDeadShare) / (1 - kDeadShare);
    return beyond <= 0 ? 0 : Math.sign(share) * beyond;
  };
  // Never -0: it would be sent.
  return { throttleRatio: 0 - along(downShare), rudderRatio: along(rightShare) };
}

export class Stick {
  readonly element: HTMLElement;
  private readonly knob = make("span", { class: "pad-knob" });
  private pointerId: number | undefined;

  /** `moved` gets every new setting, also the one at its release. */
  constructor(private readonly moved: (setting: HelmSetting) => void) {
    this.element = make("div", { class: "pad-stick", "data-testid": "pad-stick", role: "application", "aria-label": kPadTexts.stick }, [this.knob]);
    this.element.addEventListener("pointerdown", (event) => {
      if (this.pointerId !== undefined) return;
      this.pointerId = event.pointerId;
      if (event.isTrusted) this.element.setPointerCapture(event.pointerId);
      this.follow(event);
    });
    this.element.addEventListener("pointermove", (event) => event.pointerId === this.pointerId && this.follow(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const) this.element.addEventListener(end, (event) => event.pointerId === this.pointerId && this.release());
    this.element.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  /** Lets go of it, as when the tool changes. */
  release(): void {
    if (this.pointerId === undefined) return;
    this.pointerId = undefined;
    this.set(0, 0);
  }

  private follow({ clientX, clientY }: PointerEvent): void {
    const { left, top, width, height } = this.element.getBoundingClientRect();
    const [right, down] = [(2 * (clientX - left)) / width - 1, (2 * (clientY - top)) / height - 1];
    const far = Math.max(Math.hypot(right, down), 1);
    this.set(right / far, down / far);
  }

  private set(rightShare: number, downShare: number): void {
    this.knob.style.transform = `translate(${(50 * rightShare).toFixed(1)}%, ${(50 * downShare).toFixed(1)}%)`;
    this.moved(stickSetting(rightShare, downShare));
  }
}
