// Throttle and rudder of the user's boat, from keys and sliders. The throttle keeps its position when its keys are released; the
// rudder returns to the middle. Pure.

export type HelmKey = "ahead" | "astern" | "port" | "starboard";

const kKeys = {
  ArrowUp: "ahead", KeyW: "ahead",
  ArrowDown: "astern", KeyS: "astern",
  ArrowLeft: "port", KeyA: "port",
  ArrowRight: "starboard", KeyD: "starboard",
} as const satisfies Record<string, HelmKey>;
export type HelmCode = keyof typeof kKeys;
/** Change of the ratio per second while a key is held, and of the rudder after its keys are released. */
const kThrottlePerS = 1.4;
const kRudderPerS = 4;
const kRudderBackPerS = 6;

/** By KeyboardEvent.code: the same physical keys on every keyboard layout. */
export function helmKey(code: string): HelmKey | undefined {
  return (kKeys as Record<string, HelmKey>)[code];
}

function toward(value: number, goal: number, step: number): number {
  return value < goal ? Math.min(value + step, goal) : Math.max(value - step, goal);
}

export class Helm {
  throttle = 0;
  rudder = 0;
  private readonly held = new Set<HelmKey>();
  /** The rudder was last moved with keys, not with its slider. */
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

  /** Stops the engine and centres the rudder. */
  centre(): void {
    this.held.clear();
    this.throttle = this.rudder = 0;
    this.isRudderByKeys = false;
  }

  /** Starts from the current setting of a boat. */
  takeOver(throttle: number, rudder: number): void {
    this.centre();
    this.throttle = throttle;
    this.rudder = rudder;
  }

  /** Applies the held keys. Returns true if anything changed. */
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
