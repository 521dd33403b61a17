// The frames that the server streamed: the newest few of every layer, and the clock that chooses the time shown.
import type { BodiesFrame, FloatersFrame, FoamFrame, Frame, ParticleFrame, SurfaceFrame } from "../../net/messages";
import { unpackBodies, type BodiesState } from "./bodies";
import { unpackFloaters, type FloatersState } from "./floaters";
import { FrameRing } from "./frame_ring";
import { PlayoutClock } from "./playout_clock";

/** The four frames around the time shown, and one that came early. */
const kRingCount = 5;

export class StreamedFrames {
  readonly clock = new PlayoutClock();
  readonly surfaces: FrameRing<SurfaceFrame>;
  readonly particles: FrameRing<ParticleFrame>;
  readonly foam: FrameRing<FoamFrame>;
  readonly bodies = new FrameRing<BodiesState>(kRingCount, () => {});
  readonly floaters = new FrameRing<FloatersState>(kRingCount, () => {});
  private clockLayer: Frame["layer"] = "surface";

  /** `release` takes back the frames that are not needed any more. */
  constructor(private readonly release: (frame: Frame) => void) {
    this.surfaces = new FrameRing<SurfaceFrame>(kRingCount, release);
    this.particles = new FrameRing<ParticleFrame>(kRingCount, release);
    this.foam = new FrameRing<FoamFrame>(kRingCount, release);
  }

  /** `hasWave`: the room sends surfaces. Unless it has the same water as the one before, the frames of that one are returned. */
  enter(hasWave: boolean, isSameWater: boolean): void {
    if (!isSameWater) {
      for (const ring of [this.surfaces, this.particles, this.foam, this.bodies, this.floaters]) ring.clear();
      this.clock.reset();
    }
    // Only one layer sets the clock: the layers of a tick arrive one after the other, and a late one would look like time going back.
    this.clockLayer = hasWave ? "surface" : "particles";
  }

  /** Takes ownership of a frame; `nowS`: client time. */
  take(frame: Frame, nowS: number): void {
    if (frame.layer === "surface") this.surfaces.push(frame);
    else if (frame.layer === "particles") this.particles.push(frame);
    else if (frame.layer === "foam") this.foam.push(frame);
    else if (frame.layer === "floaters") this.takeFloaters(frame);
    else this.takeBodies(frame);
    if (frame.layer === this.clockLayer) this.clock.noteFrame(frame.timeS, frame.serverTimeS, nowS);
  }

  private takeBodies(frame: BodiesFrame): void {
    this.bodies.push(unpackBodies(frame));
    this.release(frame);
  }

  private takeFloaters(frame: FloatersFrame): void {
    this.floaters.push(unpackFloaters(frame));
    this.release(frame);
  }
}
