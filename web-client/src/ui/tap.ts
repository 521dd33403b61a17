// Distinguishes a click or tap from a drag.
import { kClickRadiusPx } from "../scene/camera/camera_hand";

export interface PointerSample {
  id: number;
  xPx: number;
  yPx: number;
  timeMs: number;
}

/** A press that is held no longer is a tap. */
export const kTapMs = 600;

export class TapDetector {
  private down: PointerSample | undefined;
  private readonly held = new Set<number>();

  pressed(sample: PointerSample): void {
    this.held.add(sample.id);
    // A second finger starts a gesture.
    this.down = this.held.size === 1 ? sample : undefined;
  }

  /** Returns true if this release ends a tap. */
  released(sample: PointerSample): boolean {
    this.held.delete(sample.id);
    const down = this.down;
    this.down = undefined;
    if (!down || down.id !== sample.id) return false;
    const distancePx = Math.hypot(sample.xPx - down.xPx, sample.yPx - down.yPx);
    return distancePx <= kClickRadiusPx && sample.timeMs - down.timeMs <= kTapMs;
  }

  cancelled(id: number): void {
    this.held.delete(id);
    this.down = undefined;
  }
}

/** Position on an element → normalized device coordinates, x right and y up, -1..1. */
export function toDeviceCoordinates(
  xPx: number,
  yPx: number,
  box: { left: number; top: number; width: number; height: number },
): { x: number; y: number } {
  return { x: ((xPx - box.left) / box.width) * 2 - 1, y: 1 - ((yPx - box.top) / box.height) * 2 };
}
