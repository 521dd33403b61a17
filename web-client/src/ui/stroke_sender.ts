// Fingers in the water → messages of strokes: the points of each finger, together once per interval. Clock and timers are injected.
import type { MessageInitShape } from "@bufbuild/protobuf";

import type { StrokeSchema } from "../../client/gen/spindrift/v1/wire_pb";
import type { SenderWorld } from "./latest_sender";
import type { StrokeSize } from "./tools";
import { kTexts } from "./texts";

export interface FingerPoint {
  timeMs: number;
  xM: number;
  zM: number;
  /** 0 to 1. */
  pressureRatio: number;
}

/** Label of its commands. */
export const kStrokeLabel = kTexts.commands.stroke;

export type StrokeMessage = MessageInitShape<typeof StrokeSchema>;

const kIntervalMs = 33;
/** More fingers take turns at a lower rate, within the commands per second that the server takes from a session. */
const kFullRateFingers = 4;
/** A resting finger is heard of this often; the server lifts one that is silent for 2 s. */
const kRestMs = 700;
/** Points nearer in time add nothing. */
const kSpacingMs = 4;
/** Most points of a message, as the server allows. */
const kPointsMax = 64;

interface Finger {
  /** Sent with every message: the server begins a stroke anew that it has lost, as after a reset. */
  size: StrokeSize;
  strokeId: number;
  beganMs: number;
  sentMs: number;
  last: FingerPoint;
  unsent: FingerPoint[];
}

export class StrokeSender {
  private nextId = 1;
  private readonly fingers = new Map<number, Finger>();
  private timer: number | undefined;

  constructor(
    private readonly send: (stroke: StrokeMessage) => void,
    private readonly world: SenderWorld,
  ) {}

  /** A finger begins a stroke, with what it has drawn already. */
  begin(pointerId: number, points: readonly FingerPoint[], size: StrokeSize): void {
    const first = points[0];
    if (!first) return;
    const finger: Finger = { size, strokeId: this.nextId++, beganMs: first.timeMs, sentMs: this.world.nowMs(), last: first, unsent: [first] };
    this.fingers.set(pointerId, finger);
    for (const point of points.slice(1)) add(finger, point);
    this.post(finger, {});
    this.timer ??= this.world.setTimer(() => this.flush(), this.intervalMs);
  }

  /** Sends a stroke that stays where it is for a while. */
  stay({ xM, zM }: { xM: number; zM: number }, size: StrokeSize, forS: number, pressureRatio: number): void {
    const points = [0, forS].map((timeS) => ({ timeS, xM, zM, pressureRatio }));
    this.send({ strokeId: this.nextId++, points, ends: true, ...size });
  }

  move(pointerId: number, point: FingerPoint): void {
    const finger = this.fingers.get(pointerId);
    if (finger) add(finger, point);
  }

  end(pointerId: number): void {
    const finger = this.fingers.get(pointerId);
    if (!finger) return;
    this.fingers.delete(pointerId);
    this.post(finger, { ends: true });
  }

  private get intervalMs(): number {
    return kIntervalMs * Math.max(this.fingers.size / kFullRateFingers, 1);
  }

  private flush(): void {
    this.timer = this.fingers.size > 0 ? this.world.setTimer(() => this.flush(), this.intervalMs) : undefined;
    const nowMs = this.world.nowMs();
    for (const finger of this.fingers.values()) {
      if (finger.unsent.length === 0 && nowMs - finger.sentMs >= kRestMs) add(finger, { ...finger.last, timeMs: Math.max(nowMs, finger.last.timeMs + kSpacingMs) });
      if (finger.unsent.length > 0) this.post(finger, {});
    }
  }

  private post(finger: Finger, more: StrokeMessage): void {
    const points = finger.unsent.splice(0).slice(-kPointsMax);
    finger.sentMs = this.world.nowMs();
    this.send({
      strokeId: finger.strokeId,
      ...finger.size,
      points: points.map(({ timeMs, ...rest }) => ({ timeS: (timeMs - finger.beganMs) / 1000, ...rest })),
      ...more,
    });
  }
}

function add(finger: Finger, point: FingerPoint): void {
  if (point.timeMs < finger.last.timeMs + kSpacingMs) return;
  finger.last = point;
  finger.unsent.push(point);
}
