// Objects that are held → messages that pull them: one per interval and object, with the newest position. Clock and timers are injected.
import type { MessageInitShape } from "@bufbuild/protobuf";

import type { HoldFloaterSchema } from "../../client/gen/spindrift/v1/wire_pb";
import { clamp } from "../scene/maths/interpolate";
import type { SenderWorld } from "./latest_sender";
import type { WaterPlace } from "./tools";
import { kTexts } from "./texts";

/** Label of its commands. */
export const kHoldLabel = kTexts.commands.hold;

export type HoldMessage = MessageInitShape<typeof HoldFloaterSchema>;

const kIntervalMs = 40;
/** More objects take turns at a lower rate, within the commands per second that the server takes from a session. */
const kFullRateHolds = 2;
/** An angle is turned at a rate that would take this long, so that it begins at once and ends smoothly. */
const kTurnS = 0.15;
/** As the server allows [rad/s]. */
const kFastestTurn = 10;

interface Hold {
  floaterId: number;
  placeNow: () => WaterPlace;
  /** Still to be turned. */
  angleRad: number;
}

export class HoldSender {
  private readonly holds = new Map<number, Hold>();
  /** Commands without an answer, and whose they are. */
  private readonly sent = new Map<number, number>();
  private timer: number | undefined;

  /** `send` returns the command's id; 0 if nothing was sent. `lost`: the server does not let this pointer hold its object any more. */
  constructor(
    private readonly send: (hold: HoldMessage) => number,
    private readonly lost: (pointerId: number) => void,
    private readonly world: SenderWorld,
  ) {}

  /** `placeNow` is asked before each message: the camera may move under a resting pointer. */
  begin(pointerId: number, floaterId: number, placeNow: () => WaterPlace): void {
    this.holds.set(pointerId, { floaterId, placeNow, angleRad: 0 });
    this.post(pointerId);
    this.timer ??= this.world.setTimer(() => this.flush(), this.intervalMs);
  }

  /** Returns what the pointer holds; 0: nothing. */
  heldBy(pointerId: number): number {
    return this.holds.get(pointerId)?.floaterId ?? 0;
  }

  /** Pointers that hold something, the newest last. */
  pointers(): number[] {
    return [...this.holds.keys()];
  }

  /** Turns what a pointer holds; positive from +x toward +z. */
  turn(angleRad: number, pointerId: number): void {
    const hold = this.holds.get(pointerId);
    if (hold) hold.angleRad += angleRad;
  }

  end(pointerId: number): void {
    const hold = this.holds.get(pointerId);
    if (!hold) return;
    this.holds.delete(pointerId);
    this.send({ floaterId: hold.floaterId, ...hold.placeNow(), ends: true });
  }

  /** Ends without a message: the object is gone. */
  drop(pointerId: number): void {
    this.holds.delete(pointerId);
  }

  answered(commandId: number, isRejected: boolean): void {
    const pointerId = this.sent.get(commandId);
    this.sent.delete(commandId);
    if (!isRejected || pointerId === undefined || !this.holds.has(pointerId)) return;
    this.drop(pointerId);
    this.lost(pointerId);
  }

  private get intervalMs(): number {
    return kIntervalMs * Math.max(this.holds.size / kFullRateHolds, 1);
  }

  private flush(): void {
    this.timer = this.holds.size > 0 ? this.world.setTimer(() => this.flush(), this.intervalMs) : undefined;
    for (const pointerId of [...this.holds.keys()]) this.post(pointerId);
  }

  private post(pointerId: number): void {
    const hold = this.holds.get(pointerId)!;
    const turnRadps = clamp(hold.angleRad / kTurnS, -kFastestTurn, kFastestTurn);
    hold.angleRad -= (turnRadps * this.intervalMs) / 1000;
    if (Math.abs(hold.angleRad) < 1e-3) hold.angleRad = 0;
    const commandId = this.send({ floaterId: hold.floaterId, ...hold.placeNow(), turnRadps });
    if (commandId > 0) this.sent.set(commandId, pointerId);
  }
}
