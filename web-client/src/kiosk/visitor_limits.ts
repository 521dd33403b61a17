// What visitors of a kiosk may send, whatever their role: a few kinds of commands, at limited rates. The server's limits come on top. Gauges
// are not among them: without the panel nobody could read or remove them. Pure.
import type { CommandAction } from "../../client/session/events";

/** Commands per second, and how many may come at once. */
const kRates = {
  splash: { perS: 2, burst: 6 },
  breakingWave: { perS: 0.2, burst: 2 },
  spawnBoat: { perS: 0.1, burst: 1 },
  spawnFloater: { perS: 1, burst: 5 },
} as const;
type Rated = keyof typeof kRates;
/** Their senders limit them, and what began has to end. */
const kUnrated: readonly CommandAction["case"][] = ["stroke", "holdFloater", "controlBoat"];

/** Most objects of a visit in the water; the oldest one is taken out for a new one. */
const kFloatersMaxCount = 12;

export class VisitorLimits {
  /** Objects that visitors have put into the water, oldest first. */
  readonly floaterIds: number[] = [];
  refusedCount = 0;
  private readonly budgets = new Map<Rated, { left: number; atMs: number }>();

  /** True if a visitor may send this now, which counts as sent. `ownBoatIds`: boats of this page. */
  takes(action: CommandAction, ownBoatIds: readonly number[], nowMs: number): boolean {
    const isTaken = this.allows(action, ownBoatIds, nowMs);
    if (!isTaken) ++this.refusedCount;
    return isTaken;
  }

  /** The server has made an object for this page. Returns those that are too many. */
  added(floaterId: number): number[] {
    this.floaterIds.push(floaterId);
    return this.floaterIds.slice(0, Math.max(this.floaterIds.length - kFloatersMaxCount, 0));
  }

  /** An object is taken out. */
  removed(floaterId: number): void {
    const at = this.floaterIds.indexOf(floaterId);
    if (at >= 0) this.floaterIds.splice(at, 1);
  }

  private allows(action: CommandAction, ownBoatIds: readonly number[], nowMs: number): boolean {
    if (kUnrated.includes(action.case)) return true;
    if (action.case === "removeBoat") return ownBoatIds.includes(action.value.boatId ?? 0);
    if (action.case === "removeFloater") return action.value.all !== true && this.floaterIds.includes(action.value.floaterId ?? 0);
    if (action.case === "spawnBoat" && ownBoatIds.length > 0) return false;
    return action.case in kRates && this.spends(action.case as Rated, nowMs);
  }

  private spends(kind: Rated, nowMs: number): boolean {
    const { perS, burst } = kRates[kind];
    const { left, atMs } = this.budgets.get(kind) ?? { left: burst, atMs: nowMs };
    const now = Math.min(burst, left + (Math.max(nowMs - atMs, 0) / 1000) * perS);
    this.budgets.set(kind, { left: now >= 1 ? now - 1 : now, atMs: nowMs });
    return now >= 1;
  }
}
