// Commands that wait for their ack or reject. Bounded, so that a client without answers stops sending.

export const kMaxPendingCount = 64;

export class PendingCommands {
  private readonly untilMs = new Map<number, number>();

  get isFull(): boolean {
    return this.untilMs.size >= kMaxPendingCount;
  }

  /** `untilMs`: when it is overdue; Infinity for a command that may take as long as it needs. */
  add(commandId: number, untilMs: number): void {
    this.untilMs.set(commandId, untilMs);
  }

  /** True for the first answer to a command of this connection. */
  answered(commandId: number): boolean {
    return this.untilMs.delete(commandId);
  }

  /** Removes and returns the commands that have waited for too long. */
  takeOverdue(nowMs: number): number[] {
    const overdue = [...this.untilMs].filter(([, untilMs]) => nowMs >= untilMs).map(([commandId]) => commandId);
    for (const commandId of overdue) this.untilMs.delete(commandId);
    return overdue;
  }

  takeAll(): number[] {
    const all = [...this.untilMs.keys()];
    this.untilMs.clear();
    return all;
  }
}
