// What a Draining message asks for: when to connect anew, and to which address.
import type { DrainingInfo } from "../codec/parse";

export interface MovePlan {
  atMs: number;
  url: string;
}

/** A server that is told to wait longer would look like one that is gone. */
const kLongestWaitS = 60;

/** `url`: of the present connection; its path, which names the room, stays. `random` in [0, 1). */
export function planMove(draining: DrainingInfo, url: string, random: number, nowMs: number): MovePlan {
  const { goTo, reconnectAfterMinS, reconnectAfterMaxS } = draining;
  const waitS = Math.min(reconnectAfterMinS + random * (reconnectAfterMaxS - reconnectAfterMinS), kLongestWaitS);
  const path = url.replace(/^wss?:\/\/[^/]*/, "");
  return { atMs: nowMs + waitS * 1000, url: goTo === "" ? url : goTo.replace(/\/$/, "") + path };
}
