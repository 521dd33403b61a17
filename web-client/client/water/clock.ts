// A room's clock in the hands of a client.
import type { Ack, Commands } from "./commands";
import { SpindriftError } from "./errors";

/** As the server's rules for `step`. */
export const kStepTicksMax = 600;

/** The answer to steps that are done. */
export interface StepAck extends Ack {
  /** Of the state after `appliedTick`. */
  stateHash: bigint;
}

/** `takeClock` gives one: the room advances only by `step` until `release`. With several holders, by the ticks that all of them have asked for. */
export class Clock {
  private isReleased = false;

  /** Use `takeClock`. */
  constructor(private readonly water: Pick<Commands, "step" | "releaseClock">) {}

  /** Advances the room; resolved when the ticks are done: `appliedTick` is the last of them. More than 600 ticks are several commands. Rejects
   *  as commands do: with Rejected if the clock was lost, or if something else, such as a reset, ended the steps. */
  async step(tickCount = 1): Promise<StepAck> {
    if (!(Number.isInteger(tickCount) && tickCount >= 1)) throw new RangeError(`tickCount ${tickCount}: expected a whole number above 0`);
    for (let left = tickCount; ; left -= kStepTicksMax) {
      const ack = await this.water.step({ tickCount: Math.min(left, kStepTicksMax), waits: true });
      if (left <= kStepTicksMax) return { ...ack, stateHash: ack.stateHash ?? 0n };
    }
  }

  /** Gives the clock back, once. A clock that was lost meanwhile is no error: the room has it already. */
  async release(): Promise<void> {
    if (this.isReleased) return;
    this.isReleased = true;
    await this.water.releaseClock().catch((error: unknown) => {
      if (!(error instanceof SpindriftError)) throw error;
    });
  }
}
