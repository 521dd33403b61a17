// Whether this device keeps up with unpacking what it asked for: the share of its time that the worker spends on it decides
// which level of detail to ask for. The link is the server's business, it sees what waits.
import { kLevelNames, type LevelName } from "../codec/level";

const kTooBusy = 0.6;
/** A level has up to four times what the one below it has. */
const kIdle = 0.12;
const kBusyNotes = 4;
const kFirstIdleNotes = 20;
const kMaxIdleNotes = 240;

export class LoadGovernor {
  private at = kLevelNames.length - 1;
  private busyCount = 0;
  private idleCount = 0;
  private idleWanted = kFirstIdleNotes;
  private raised = false;

  get level(): LevelName {
    return kLevelNames[this.at]!;
  }

  /** `busyShare` of the last half second, 0..1; whether the level has changed. */
  note(busyShare: number): boolean {
    this.busyCount = busyShare > kTooBusy ? this.busyCount + 1 : 0;
    this.idleCount = busyShare < kIdle ? this.idleCount + 1 : 0;
    if (this.busyCount >= kBusyNotes && this.at > 0) {
      // What did not hold is tried again after twice the time.
      if (this.raised) this.idleWanted = Math.min(2 * this.idleWanted, kMaxIdleNotes);
      return this.step(-1);
    }
    return this.idleCount >= this.idleWanted && this.at < kLevelNames.length - 1 ? this.step(1) : false;
  }

  private step(by: 1 | -1): boolean {
    this.at += by;
    this.raised = by > 0;
    this.busyCount = this.idleCount = 0;
    return true;
  }
}
