// The message that the server is about to end, checked.

/** The message as read, bounded. */
export interface DrainingInfo {
  closesInS: number;
  /** ws://HOST or wss://HOST; empty: the same server. */
  goTo: string;
  reconnectAfterMinS: number;
  reconnectAfterMaxS: number;
}

/** Returns why the message cannot be trusted, or the message. */
export function readDraining({ closesInS, goTo, reconnectAfterMinS, reconnectAfterMaxS }: DrainingInfo): DrainingInfo | string {
  if (![closesInS, reconnectAfterMinS, reconnectAfterMaxS].every((value) => Number.isFinite(value) && value >= 0) || reconnectAfterMaxS < reconnectAfterMinS)
    return `draining: times ${closesInS}, ${reconnectAfterMinS} and ${reconnectAfterMaxS} s`;
  if (goTo !== "" && !/^wss?:\/\/[^/?#@]+\/?$/.test(goTo)) return `draining: ${goTo} is no address of a server`;
  return { closesInS, goTo, reconnectAfterMinS, reconnectAfterMaxS };
}
