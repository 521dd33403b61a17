// Says what others did to the water, and what the server did by itself. What this page asked for is seen in the water and in its controls.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { PageEvent } from "../net/messages";
import { kTexts } from "./texts";

type RoomState = Pick<Extract<PageEvent, { kind: "roomState" }>, "paused" | "speed" | "personId">;
type RoomEvent = Pick<Extract<PageEvent, { kind: "roomEvent" }>, "event" | "message" | "personId">;

interface NewsWorld {
  say(text: string, tone: "good" | "warn"): void;
  /** Undefined for people who are not in the list, and for 0. */
  nameOf(personId: number): string | undefined;
  /** Id of this visitor. */
  ownId(): number;
  /** This page waits for the answer to its own change of scene or fidelity. */
  isChanging(): boolean;
}

export class RoomNews {
  private room: string | undefined;
  private sceneName = "";
  private paused = false;
  private speed = 1;
  private repeats = false;

  constructor(private readonly world: NewsWorld) {}

  enter({ room, sceneName, title, paused, speed, repeats }: Pick<GreetingInfo, "room" | "sceneName" | "title" | "paused" | "speed" | "repeats">): void {
    const isOther = this.room === room && this.sceneName !== sceneName;
    Object.assign(this, { room, sceneName, paused, speed, repeats });
    if (isOther && !this.world.isChanging()) this.world.say(kTexts.otherScene(kTexts.scenes[sceneName]?.title ?? title), "good");
  }

  state({ paused, speed, personId }: RoomState): void {
    const before = { paused: this.paused, speed: this.speed };
    Object.assign(this, { paused, speed });
    if (paused !== before.paused) this.sayWho(personId, paused ? kTexts.pausedBy : kTexts.resumedBy);
    else if (speed !== before.speed) this.sayWho(personId, (name) => kTexts.speedBy(name, speed));
  }

  event({ event, message, personId }: RoomEvent): void {
    // Every few seconds, by the scene itself.
    if (event === "reset" && this.repeats) return;
    if (event === "reset") return this.sayWho(personId, kTexts.startedAgainBy);
    if (event === "fidelity" && this.world.isChanging()) return;
    if (message) this.world.say(message, event === "other" ? "good" : "warn");
  }

  private sayWho(personId: number, text: (name: string) => string): void {
    if (personId !== 0 && personId === this.world.ownId()) return;
    this.world.say(text(this.world.nameOf(personId) ?? kTexts.somebody), "good");
  }
}
