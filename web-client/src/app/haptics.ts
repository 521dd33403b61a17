// What is felt: short vibrations of the phone or the gamepad for what one does oneself, and for what happens to one's own boat.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { BodiesState } from "../scene/frames/bodies";
import type { WaterScene } from "../scene/water_scene";
import { BoatWatch } from "../sound/boat_watch";
import { SoundEvents } from "../sound/sound_events";
import { keepChoice, keptChoice } from "../ui/kept";
import { standardGamepad } from "./gamepad";

const kKey = "vibration";
/** Durations [ms] and strengths of a gamepad's motors, 0 to 1. */
const kFelt = {
  splash: { ms: 20, strong: 0.2, weak: 0.5 },
  catch: { ms: 25, strong: 0.5, weak: 0.2 },
  letGo: { ms: 12, strong: 0, weak: 0.4 },
  slap: { ms: 40, strong: 0.6, weak: 0.4 },
  knock: { ms: 70, strong: 1, weak: 0.6 },
};
/** A gamepad plays for at least this long: motors are slow. */
const kMotorMs = 60;
/** Id of the gamepad's pointer: far from the ids that browsers give. */
export const kGamepadId = -3;

export class Haptics {
  private isOn = keptChoice(kKey) !== "off";
  private readonly boats = new BoatWatch();
  private readonly events = new SoundEvents();
  private bodies: BodiesState | undefined;

  get wanted(): boolean {
    return this.isOn;
  }

  set wanted(isOn: boolean) {
    this.isOn = isOn;
    keepChoice(kKey, isOn ? "on" : "off");
  }

  /** `by`: the pointer that did it; undefined: it is felt in every device. */
  feel(what: keyof typeof kFelt, by?: Pick<PointerEvent, "pointerId" | "pointerType">): void {
    if (!this.isOn) return;
    const { ms, strong, weak } = kFelt[what];
    if (!by || by.pointerType === "touch") navigator.vibrate?.(ms);
    if (by && by.pointerId !== kGamepadId) return;
    // Browsers refuse where the device has no such motors.
    void standardGamepad()?.vibrationActuator?.playEffect("dual-rumble", { duration: Math.max(ms, kMotorMs), strongMagnitude: strong, weakMagnitude: weak }).catch(() => {});
  }

  /** Lets a phone tell more: durations of vibration and pause in turn, ms. */
  tell(patternMs: readonly number[]): void {
    // Not on all phones.
    if (this.isOn) navigator.vibrate?.([...patternMs]);
  }

  /** Lets slaps and knocks of one's own boat be felt. Call it after each picture. */
  follow({ frames, heightAtM }: Pick<WaterScene, "frames" | "heightAtM">, greeting: GreetingInfo | undefined, boatId: number): void {
    const state = frames.bodies.newest();
    if (!this.isOn || !greeting || boatId === 0 || !state || state === this.bodies) return;
    this.bodies = state;
    this.events.clear();
    this.boats.take({ ...state, bodies: state.bodies.filter((body) => body.boatId === boatId) }, greeting.boats, greeting.gravityMps2 || 9.81, heightAtM, this.events);
    for (const event of this.events.all.slice(0, this.events.count)) if (event.kind === "slap" || event.kind === "knock") this.feel(event.kind);
  }
}
