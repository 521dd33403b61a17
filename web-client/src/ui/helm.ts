// Throttle and rudder of one's own boat, from keys and sliders. The throttle is a lever that stays where it was left; the
// rudder comes back to the middle when its keys are let go. Pure.

export type HelmKey = "ahead" | "astern" | "port" | "starboard";

const kKeys: Record<string, HelmKey> = {
  ArrowUp: "ahead", KeyW: "ahead",
  ArrowDown: "astern", KeyS: "astern",
  ArrowLeft: "port", KeyA: "port",
  ArrowRight: "starboard", KeyD: "starboard",
};
/** Full travel of the lever takes this many seconds a unit, of the rudder likewise. */
const kThrottlePerS = 1.4;
const kRudderPerS = 4;
const kRudderBackPerS = 6;

/** By KeyboardEvent.code, so that WASD lies where it lies on every keyboard. */
export function helmKey(code: string): HelmKey | undefined {
  return kKeys[code];
}

function toward(value: number, goal: number, step: number): number {
  return value < goal ? Math.min(value + step, goal) : Math.max(value - step, goal);
}

export class Helm {
  throttle = 0;
  rudder = 0;
  private readonly held = new Set<HelmKey>();
  /** The rudder was last moved by keys, not by its slider. */
  private isRudderByKeys = false;

  press(key: HelmKey): void {
    this.held.add(key);
  }

  release(key: HelmKey): void {
    this.held.delete(key);
  }

  setThrottle(ratio: number): void {
    this.throttle = ratio;
  }

  setRudder(ratio: number): void {
    this.rudder = ratio;
    this.isRudderByKeys = false;
  }

  /** Another boat, or nobody at the helm. */
  centre(): void {
    this.held.clear();
    this.throttle = this.rudder = 0;
    this.isRudderByKeys = false;
  }

  /** Takes over what a boat is set to. */
  takeOver(throttle: number, rudder: number): void {
    this.centre();
    this.throttle = throttle;
    this.rudder = rudder;
  }

  /** Moves what keys move; true where anything changed. */
  advance(elapsedS: number): boolean {
    const { throttle, rudder } = this;
    const along = Number(this.held.has("ahead")) - Number(this.held.has("astern"));
    const across = Number(this.held.has("starboard")) - Number(this.held.has("port"));
    if (along !== 0) this.throttle = toward(throttle, along, kThrottlePerS * elapsedS);
    if (across !== 0) {
      this.isRudderByKeys = true;
      this.rudder = toward(rudder, across, kRudderPerS * elapsedS);
    } else if (this.isRudderByKeys) {
      this.rudder = toward(rudder, 0, kRudderBackPerS * elapsedS);
    }
    return this.throttle !== throttle || this.rudder !== rudder;
  }
}
