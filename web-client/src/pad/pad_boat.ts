// One's boat on the pad: launches it, steers it with the stick or keys, takes it off the water.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { CommandAction } from "../../client/session/events";
import { boatLimits, boatOfLength } from "../ui/effect_limits";
import { Helm, helmKey } from "../ui/helm";
import { LatestSender, type SenderWorld } from "../ui/latest_sender";
import { spawnPlace } from "../ui/spawn_place";
import type { WaterPlace } from "../ui/tools";
import { kMidships, type HelmSetting } from "./stick";
import { kTexts } from "../ui/texts";

/** At most so often. */
const kHelmEveryMs = 60;
const kLongestStepS = 0.1;
/** Label of the helm's commands, whose refusals are not worth a line each. */
export const kPadHelmLabel = kTexts.commands.helm;

export class PadBoat {
  /** Of this visitor; 0: none. */
  boatId = 0;
  private readonly orders: LatestSender<HelmSetting>;
  private readonly keys = new Helm();
  private lastS = 0;

  constructor(
    private readonly send: (action: CommandAction, label: string) => number,
    world: SenderWorld,
  ) {
    this.orders = new LatestSender((setting) => {
      if (this.boatId !== 0) send({ case: "controlBoat", value: { boatId: this.boatId, ...setting } }, kPadHelmLabel);
    }, world, kHelmEveryMs);
  }

  /** `others`: where boats are. A course has a grid of its own at its start. */
  launch(greeting: GreetingInfo, others: WaterPlace[]): void {
    const limits = boatLimits(greeting);
    if (!limits) return;
    const { draughtM, ...hull } = boatOfLength(limits.lengthM.default);
    const place = greeting.course ? {} : spawnPlace(greeting, hull.lengthM, draughtM, others);
    this.send({ case: "spawnBoat", value: { boat: { ...hull, ...place } } }, kTexts.commands.boat);
  }

  /** Takes the boat off the water. */
  remove(): void {
    if (this.boatId !== 0) this.send({ case: "removeBoat", value: { boatId: this.boatId } }, kTexts.commands.boat);
  }

  steer(setting: HelmSetting): void {
    // So that keys do not continue from where they were before the stick.
    this.keys.centre();
    this.orders.offer(setting);
  }

  /** Stops engine and rudder, as when the pad is put away. */
  rest(): void {
    this.keys.centre();
    this.orders.offer(kMidships);
    this.orders.flush();
  }

  /** Returns true for a key of the helm. */
  key(code: string, isDown: boolean): boolean {
    const key = helmKey(code);
    if (!key || this.boatId === 0) return false;
    if (isDown) this.keys.press(key);
    else this.keys.release(key);
    return true;
  }

  /** Moves throttle and rudder while keys are held; called for each picture. */
  update(nowS: number): void {
    const elapsedS = Math.min(nowS - this.lastS, kLongestStepS);
    this.lastS = nowS;
    if (this.keys.advance(elapsedS)) this.orders.offer({ throttleRatio: this.keys.throttle, rudderRatio: this.keys.rudder });
  }
}
