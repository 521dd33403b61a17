// State of one parameter slider: the server's value, the value shown, the commands not yet answered, and the last error. No DOM;
// timers are injected.

export const kDebounceMs = 80;

interface SliderWorld {
  /** Sends the value; returns the command id that ack or reject will carry. */
  send(value: number): number;
  setTimer(callback: () => void, ms: number): number;
  clearTimer(timer: number): void;
  /** Value or error changed. */
  changed(): void;
}

export class SliderModel {
  shownValue: number;
  error = "";
  private timer: number | undefined;
  private readonly sent = new Map<number, number>();
  private newestId = 0;

  constructor(
    private serverValue: number,
    private readonly world: SliderWorld,
  ) {
    this.shownValue = serverValue;
  }

  /** The user moved the slider. The value is sent when the slider has rested for kDebounceMs. */
  input(value: number): void {
    this.shownValue = value;
    this.error = "";
    if (this.timer !== undefined) this.world.clearTimer(this.timer);
    this.timer = this.world.setTimer(() => {
      this.timer = undefined;
      this.newestId = this.world.send(value);
      this.sent.set(this.newestId, value);
    }, kDebounceMs);
    this.world.changed();
  }

  /** Returns true if the command came from this slider. */
  ack(commandId: number): boolean {
    const value = this.sent.get(commandId);
    if (value === undefined) return false;
    this.sent.delete(commandId);
    this.serverValue = value;
    return true;
  }

  /** Returns to the server's value, unless the user has moved the slider since. Returns true as ack() does. */
  reject(commandId: number, message: string): boolean {
    if (!this.sent.delete(commandId)) return false;
    if (commandId === this.newestId && this.timer === undefined) {
      this.shownValue = this.serverValue;
      this.error = message;
      this.world.changed();
    }
    return true;
  }

  /** The server has another value, set by any user. A slider that is being moved keeps the user's value until the answer comes. */
  setServerValue(value: number): void {
    this.serverValue = value;
    if (this.timer !== undefined || this.sent.size > 0) return;
    this.shownValue = value;
    this.world.changed();
  }

  dispose(): void {
    if (this.timer !== undefined) this.world.clearTimer(this.timer);
    this.timer = undefined;
    this.sent.clear();
  }
}
