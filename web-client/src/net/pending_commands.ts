// Commands that wait for their ack or reject. Bounded, so that a page without answers stops sending.

export const kMaxPendingCount = 64;

export class PendingCommands {
  private readonly sinceMs = new Map<number, number>();

  get isFull(): boolean {
    return this.sinceMs.size >= kMaxPendingCount;
  }

  add(commandId: number, nowMs: number): void {
    this.sinceMs.set(commandId, nowMs);
  }

  /** True for the first answer to a command of this connection. */
  answered(commandId: number): boolean {
    return this.sinceMs.delete(commandId);
  }

  /** Removes and returns the commands that have waited for at least `limitMs`. */
  takeOverdue(nowMs: number, limitMs: number): number[] {
    const overdue = [...this.sinceMs].filter(([, sinceMs]) => nowMs - sinceMs >= limitMs).map(([commandId]) => commandId);
    for (const commandId of overdue) this.sinceMs.delete(commandId);
    return overdue;
  }

  takeAll(): number[] {
    const all = [...this.sinceMs.keys()];
    this.sinceMs.clear();
    return all;
  }
}
