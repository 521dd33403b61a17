// The look of the water: the list, the colour bar and the probe, which reads the water under the pointer, under the last touch, or in the
// middle of the picture while the canvas has the keyboard.
import type { GreetingInfo } from "../../client/codec/greeting";
import { chooseLook, looksOf, needsExactParticles, type LookName } from "../scene/looks/looks";
import { LookKey } from "../ui/look_key";
import { LookRow } from "../ui/look_row";
import { ProbeLabel, type ProbePlace } from "../ui/probe_label";
import { setAddressParameter } from "./address";
import type { Display } from "./display";
import { rayAt } from "./pointer_ray";

/** The probe reads this often, and less often where reading takes long: at most this share of the time. */
const kProbeEveryS = 0.1;
const kProbeShare = 0.1;

export class LookControls {
  private readonly key = new LookKey();
  private readonly label = new ProbeLabel();
  private readonly row = new LookRow((look) => this.choose(look));
  private greeting: GreetingInfo | undefined;
  private pointer: ProbePlace | undefined;
  private nextProbeS = 0;

  /** `setExactParticles`: asks the server for particles with fine or with coarse values. */
  constructor(
    private readonly display: Display,
    private readonly setExactParticles: (exact: boolean) => void,
  ) {
    display.scene.setLook(chooseLook(location.search));
    const { canvas } = display;
    const follow = ({ clientX: xPx, clientY: yPx, pointerType }: PointerEvent): void => {
      this.pointer = { xPx, yPx, isTouch: pointerType === "touch" };
      this.nextProbeS = 0;
    };
    canvas.addEventListener("pointerdown", follow);
    canvas.addEventListener("pointermove", follow);
    // A finger that is lifted leaves the probe where it was.
    canvas.addEventListener("pointerleave", ({ pointerType }) => {
      if (pointerType !== "touch") this.pointer = undefined;
    });
    // Keys take over from a finger.
    canvas.addEventListener("keydown", () => {
      if (this.pointer?.isTouch) this.pointer = undefined;
    });
  }

  enter(greeting: GreetingInfo): void {
    this.greeting = greeting;
    this.refresh();
  }

  /** Call it after each picture, while the frames that it shows are there. */
  update(nowS: number): void {
    const hasValues = this.showKey();
    const place = hasValues ? (this.pointer ?? this.middle()) : undefined;
    if (!place) return this.label.hide();
    if (nowS < this.nextProbeS) return;
    const startedS = performance.now() / 1000;
    this.label.show(this.read(place), place);
    const tookS = performance.now() / 1000 - startedS;
    this.nextProbeS = nowS + Math.max(kProbeEveryS, tookS / kProbeShare);
  }

  /** Returns true if the look has values. */
  private showKey(): boolean {
    const { legend } = this.display.scene;
    if (this.key.show(legend)) this.display.resize();
    if (!legend) this.label.hide();
    return legend !== undefined;
  }

  private choose(look: LookName): void {
    this.display.scene.setLook(look);
    setAddressParameter("look", look === "natural" ? undefined : look);
    this.refresh();
  }

  private refresh(): void {
    if (!this.greeting) return;
    const { look } = this.display.scene;
    this.row.show(looksOf(this.greeting), look);
    this.setExactParticles(needsExactParticles(look));
    this.showKey();
  }

  private read({ xPx, yPx }: ProbePlace): ReturnType<Display["scene"]["probe"]> {
    return this.display.scene.probe(rayAt(this.display, xPx, yPx));
  }

  private middle(): ProbePlace | undefined {
    if (!this.display.canvas.matches(":focus-visible")) return undefined;
    const { leftPx, topPx, rightPx, bottomPx } = this.display.freePart;
    return { xPx: (leftPx + rightPx) / 2, yPx: (topPx + bottomPx) / 2, isTouch: false };
  }
}
