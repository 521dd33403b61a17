// What happened since the last frame and is heard once: at most kEventsMax, of which the largest are kept. The objects are reused.

type EventKind = "splash" | "plunge" | "slap" | "knock";

export interface SoundEvent {
  kind: EventKind;
  xM: number;
  yM: number;
  zM: number;
  /** Of the water that is thrown up. */
  areaM2: number;
  /** Of what falls in; it gives the pitch. */
  radiusM: number;
  /** Of the boat; 0: none. */
  boatId: number;
}

const kEventsMax = 48;

export class SoundEvents {
  count = 0;
  readonly all: readonly SoundEvent[] = Array.from({ length: kEventsMax }, () => ({ kind: "splash" as EventKind, xM: 0, yM: 0, zM: 0, areaM2: 0, radiusM: 0, boatId: 0 }));

  clear(): void {
    this.count = 0;
  }

  add(kind: EventKind, xM: number, yM: number, zM: number, areaM2: number, radiusM: number, boatId = 0): void {
    const isFull = this.count === kEventsMax;
    const event = isFull ? this.smallest() : this.all[this.count++]!;
    if (isFull && event.areaM2 >= areaM2) return;
    event.kind = kind;
    event.xM = xM;
    event.yM = yM;
    event.zM = zM;
    event.areaM2 = areaM2;
    event.radiusM = radiusM;
    event.boatId = boatId;
  }

  private smallest(): SoundEvent {
    let smallest = this.all[0]!;
    for (const event of this.all) if (event.areaM2 < smallest.areaM2) smallest = event;
    return smallest;
  }
}
