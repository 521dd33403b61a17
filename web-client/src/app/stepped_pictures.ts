// Pictures on request instead of at display rate, for the page opened with `?pictures=stepped`: the same frames of the server give the same
// picture, however slow the machine is. Tests and the gallery use it (docs/contributing.md); the panels work as always.
import type { FrameLayer } from "../../client/codec/layers";
import type { Frame } from "../net/messages";
import type { App } from "./app";
import { nowS, setNowS } from "./picture_clock";

/** A frame is of the wanted time if it is at most this far off: a quarter of the shortest tick. */
const kSameTimeS = 1 / 960;
type Point = [xM: number, yM: number, zM: number];

export function wantsSteppedPictures(search: string): boolean {
  return new URLSearchParams(search).get("pictures") === "stepped";
}

export class SteppedPictures {
  private takenS = 0;
  private wanted: { timeS: number; missing: Set<FrameLayer>; done: () => void } | undefined;

  constructor(private readonly app: App) {
    app.display.accepts = (frame) => this.accepts(frame);
    setNowS(0);
  }

  /**
   * Takes one frame of each layer at a time of the simulation; all other frames are dropped. Resolves once they are here. The clock of the
   * pictures moves on as far as the simulation did.
   */
  take(timeS: number): Promise<void> {
    setNowS(nowS() + Math.max(timeS - this.takenS, 0));
    this.takenS = timeS;
    return new Promise((done) => (this.wanted = { timeS, missing: new Set(this.app.display.layers), done }));
  }

  /** Lets time pass for the camera and the light, but not for the water. */
  pass(seconds: number): void {
    setNowS(nowS() + seconds);
  }

  /** Draws the water at a time. The canvas can be read until the calling task ends. */
  draw(timeS: number): void {
    const { display } = this.app;
    display.scene.clock.hold(timeS);
    display.draw();
  }

  /** Lets white water and wet ground become what they are at a time, without a picture. */
  remember(timeS: number): void {
    const { scene } = this.app.display;
    scene.clock.hold(timeS);
    scene.remember(nowS());
  }

  /** Places the camera. */
  look(eyeM: Point, targetM: Point): void {
    this.app.display.views.place(eyeM, targetM);
  }

  private accepts({ layer, timeS }: Frame): boolean {
    const { wanted } = this;
    if (!wanted || Math.abs(timeS - wanted.timeS) > kSameTimeS || !wanted.missing.delete(layer)) return false;
    if (wanted.missing.size === 0) {
      this.wanted = undefined;
      wanted.done();
    }
    return true;
  }
}
