// Sends commands and keeps a label for each, for the line that reports its answer.
import type { CommandAction } from "../../client/session/events";
import type { WaterClient } from "../net/water_client";
import { kTexts } from "../ui/texts";

export class CommandSender {
  /** The newest one, for tests. */
  last: CommandAction | undefined;
  /** Chooses what is sent; the rest is dropped. */
  accepts: (action: CommandAction) => boolean = () => true;
  private readonly labels = new Map<number, string>();

  constructor(private readonly client: WaterClient) {}

  /** Returns the command's id; 0 if there is no action to send, or it is not accepted. */
  readonly send = (action: CommandAction | undefined, label: string): number => {
    if (!action || !this.accepts(action)) return 0;
    const commandId = this.client.command(action);
    this.last = action;
    this.labels.set(commandId, label);
    return commandId;
  };

  /** Every command is answered exactly once, so the map stays small. */
  takeLabel(commandId: number): string {
    const label = this.labels.get(commandId) ?? kTexts.commands.numbered(commandId);
    this.labels.delete(commandId);
    return label;
  }
}
