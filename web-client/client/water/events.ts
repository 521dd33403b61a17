// What a program is told of its room.
import type { GreetingInfo } from "../codec/greeting";
import type { DrainingInfo, ParsedMessage } from "../codec/parse";
import type { WelcomeInfo } from "../codec/people";
import type { LinkStats } from "../session/events";
import type { SpindriftError } from "./errors";

type Message<K extends ParsedMessage["kind"]> = Omit<Extract<ParsedMessage, { kind: K }>, "kind">;

/** Events by name, with what their listeners get. */
export interface WaterEvents {
  /** Connected again, as a new person: the server did not know the old one any more. */
  connected: WelcomeInfo;
  /** Connected again as the same person, with the same boats. */
  resumed: WelcomeInfo;
  /** The connection was lost; the next attempt comes in so many seconds. */
  disconnected: { why: string; retryInS: number };
  /** The server ends soon. The client connects anew by itself when and where it is told to. */
  draining: DrainingInfo;
  /** Connected to another server; `connected` or `resumed` follows. */
  moved: { url: string };
  /** Nothing comes any more: the server refused this client, or, without an error, close() was called. */
  closed: { error: SpindriftError | undefined };
  /** The room has another scene, or this is another connection. */
  greeting: GreetingInfo;
  roomState: Message<"roomState">;
  roomEvent: Message<"roomEvent">;
  people: Message<"people">;
  boatList: Message<"boatList">;
  parameterChanged: Message<"parameterChanged">;
  lesson: Message<"lesson">;
  game: Message<"game">;
  strokes: Message<"strokes">;
  /** Rates of the link, twice per second. */
  stats: LinkStats;
}

type Listener<K extends keyof WaterEvents> = (event: WaterEvents[K]) => void;

export class Listeners {
  private readonly lists = new Map<keyof WaterEvents, Set<Listener<never>>>();

  /** Returns what takes the listener away again. */
  on<K extends keyof WaterEvents>(kind: K, listener: Listener<K>): () => void {
    const list = this.lists.get(kind) ?? new Set();
    this.lists.set(kind, list.add(listener));
    return () => void list.delete(listener);
  }

  /** An error of a listener does not reach the connection: the runtime reports it as uncaught. */
  emit<K extends keyof WaterEvents>(kind: K, event: WaterEvents[K]): void {
    for (const listener of [...(this.lists.get(kind) ?? [])] as Listener<K>[])
      try {
        listener(event);
      } catch (error) {
        queueMicrotask(() => {
          throw error;
        });
      }
  }
}
