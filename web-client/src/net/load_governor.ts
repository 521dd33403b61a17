// Chooses the level of detail that this device can unpack in time, by the share of time that the worker spends on messages. The
// server adapts to the link, from the frames that wait in its outbox.
import { coarserLevel, kFinestLevel, kLevels, type LevelName } from "../../client/codec/layers";
import type { DetailChoice, LinkStats } from "./messages";

const kTooBusy = 0.6;
/** A level has up to four times the samples of the next coarser one. */
const kIdle = 0.12;
const kBusyNotes = 4;
const kFirstIdleNotes = 20;
const kMaxIdleNotes = 240;

/** Returns the level that is sent, and what keeps it from the finest one. */
export function shownLevel(detail: DetailChoice, deviceLevel: LevelName, linkLevel: LevelName): Pick<LinkStats, "level" | "levelLimitedBy"> {
  const level = detail === "auto" ? coarserLevel(deviceLevel, linkLevel) : detail;
  if (level === kFinestLevel) return { level, levelLimitedBy: "none" };
  if (detail !== "auto") return { level, levelLimitedBy: "choice" };
  return { level, levelLimitedBy: level === linkLevel ? "link" : "device" };
}

export class LoadGovernor {
  private at = kLevels.length - 1;
  private busyCount = 0;
  private idleCount = 0;
  private idleWanted = kFirstIdleNotes;
  private raised = false;

  get level(): LevelName {
    return kLevels[this.at]!.name;
  }

  /** Takes the busy share of the last half second, 0..1. Returns true if the level changed. */
  note(busyShare: number): boolean {
    this.busyCount = busyShare > kTooBusy ? this.busyCount + 1 : 0;
    this.idleCount = busyShare < kIdle ? this.idleCount + 1 : 0;
    if (this.busyCount >= kBusyNotes && this.at > 0) {
      // The finer level was too much: wait twice as long before the next attempt.
      if (this.raised) this.idleWanted = Math.min(2 * this.idleWanted, kMaxIdleNotes);
      return this.step(-1);
    }
    return this.idleCount >= this.idleWanted && this.at < kLevels.length - 1 ? this.step(1) : false;
  }

  private step(by: 1 | -1): boolean {
    this.at += by;
    this.raised = by > 0;
    this.busyCount = this.idleCount = 0;
    return true;
  }
}
