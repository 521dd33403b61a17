// Pointers on the canvas: a tap, a drag or a long press on the water uses the tool, each finger for itself; everything else is left to the
// camera: the right button, two fingers that come down together, a drag that begins off the water.
import { Vector3 } from "three";

import { kClickRadiusPx } from "../scene/camera/camera_hand";
import { pickWater } from "../scene/frames/pick";
import { kStrokeLabel, StrokeSender, type FingerPoint, type StrokeMessage } from "../ui/stroke_sender";
import { kTapMs, TapDetector, toDeviceCoordinates, type PointerSample } from "../ui/tap";
import type { Outline } from "../ui/tool_preview";
import { heldRatio, kTapStrokeS, paddleWave, paddleWidthM, strokeSize, type StrokeSize, type Tool, type ToolScale, type WaterPlace } from "../ui/tools";
import type { App } from "./app";
import { nowS } from "./picture_clock";

/** Two fingers that come down within this time are a gesture of the camera. */
const kTogetherMs = 150;
const kOutlineColor = "#ffffff";

/** A pointer that began on the water. */
interface Hand {
  down: PointerEvent;
  /** As they were when it came down. */
  tool: Tool;
  scale: ToolScale;
  /** Of a tool that draws strokes. */
  size: StrokeSize | undefined;
  from: WaterPlace;
  at: WaterPlace;
  /** What it has drawn before it counts as a stroke. */
  points: FingerPoint[];
  draws: boolean;
  /** Begins the stroke of a finger that is held still. */
  timer: number;
}

export class PointerHands {
  private readonly taps = new TapDetector();
  private readonly hands = new Map<number, Hand>();
  private readonly sender: StrokeSender;
  private isHandingOver = false;
  /** Time at which a touch went to the camera. */
  private cameraTouchMs = -Infinity;
  /** Where the mouse is, while it presses nothing. */
  private hover: PointerEvent | undefined;

  constructor(private readonly app: App) {
    const send = (value: StrokeMessage): void => {
      // A finger stays down over a lost connection, and draws again on the next one.
      if (app.mayDraw) app.commands.send({ case: "stroke", value }, kStrokeLabel);
    };
    this.sender = new StrokeSender(send, {
      nowMs: () => performance.now(),
      setTimer: (callback, ms) => window.setTimeout(callback, ms),
      clearTimer: (timer) => window.clearTimeout(timer),
    });
    const { canvas } = app.display;
    // Before the camera, which listens to the same canvas and, while it turns, to the document.
    canvas.addEventListener("pointerdown", (event) => this.pressed(event), { capture: true });
    document.addEventListener("pointerdown", () => (app.display.views.takesPointers = true));
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("pointerup", (event) => this.released(event));
    canvas.addEventListener("pointerleave", () => (this.hover = undefined));
    canvas.addEventListener("pointercancel", (event) => {
      this.taps.cancelled(event.pointerId);
      this.letGo(event);
    });
    app.outline = () => this.outline();
  }

  /** Lifts all fingers. */
  liftAll(): void {
    for (const pointerId of [...this.hands.keys()]) this.lift(pointerId);
  }

  private pressed(event: PointerEvent): void {
    if (this.isHandingOver) return;
    // The camera knows the browser's pointers only.
    if (!event.isTrusted) this.app.display.views.takesPointers = false;
    this.hover = undefined;
    if (event.button === 0) this.taps.pressed(sampleOf(event));
    const { app, hands } = this;
    const isTouch = event.pointerType === "touch";
    // Keys and gamepads have no other use.
    const isFirst = app.drawing.drawsFirst || !event.isTrusted;
    if (!app.mayDraw || event.button !== (isFirst ? 0 : 2) || (isTouch && !isFirst)) return;
    const partner = isTouch ? [...hands.values()].find(({ down, draws }) => !draws && event.timeStamp - down.timeStamp < kTogetherMs && down.pointerType === "touch") : undefined;
    if (partner) return this.handOver(partner.down, event);
    const place = this.placeUnder(event);
    if (!place || (isTouch && event.timeStamp - this.cameraTouchMs < kTogetherMs)) {
      if (isTouch) this.cameraTouchMs = event.timeStamp;
      return;
    }
    app.display.views.takesPointers = false;
    // Those of keys and gamepads exist for this page only.
    if (event.isTrusted) app.display.canvas.setPointerCapture(event.pointerId);
    const { tool } = app.tools;
    const scale = { ...app.tools.scale };
    const size = strokeSize(tool, app.entered!, scale);
    if (size && tool.name === "finger") app.display.scene.ripple.press(event.pointerId, place.xM, place.zM, size, nowS());
    const timer = window.setTimeout(() => this.begin(event.pointerId), kTapMs);
    hands.set(event.pointerId, { down: event, tool, scale, size, from: place, at: place, points: [pointOf(event, place, scale)], draws: false, timer });
  }

  private moved(event: PointerEvent): void {
    const hand = this.hands.get(event.pointerId);
    if (!hand) {
      if (event.pointerType === "mouse") this.hover = event.buttons === 0 ? event : undefined;
      return;
    }
    event.stopPropagation();
    const coalesced = event.getCoalescedEvents();
    for (const each of coalesced.length > 0 ? coalesced : [event]) {
      const place = this.placeUnder(each);
      if (!place) continue;
      hand.at = place;
      if (!hand.size) continue;
      const point = pointOf(each, place, hand.scale);
      if (hand.draws) this.sender.move(event.pointerId, point);
      else hand.points.push(point);
      this.app.display.scene.ripple.move(event.pointerId, place.xM, place.zM, nowS());
    }
    if (!hand.draws && Math.hypot(event.clientX - hand.down.clientX, event.clientY - hand.down.clientY) > kClickRadiusPx) this.begin(event.pointerId);
  }

  private released(event: PointerEvent): void {
    const isTap = this.taps.released(sampleOf(event));
    const hand = this.hands.get(event.pointerId);
    this.letGo(event);
    if (event.pointerType === "mouse") this.hover = event;
    if (hand) return this.use(hand, isTap, event.timeStamp - hand.down.timeStamp);
    const place = isTap ? this.placeUnder(event) : undefined;
    if (place) this.tap(place, this.app.tools.tool, this.app.tools.scale);
  }

  /** A press with a tool has ended. */
  private use({ tool, scale, from, at }: Hand, isTap: boolean, heldMs: number): void {
    const { app } = this;
    if (!app.mayDraw) return;
    if (tool.name === "splash") {
      this.splash(at, { ...scale, sizeRatio: scale.sizeRatio * heldRatio((heldMs - kTapMs / 2) / 1000) });
    } else if (tool.name === "paddle") {
      const wave = paddleWave(from, at, app.entered!, scale);
      if (!wave) return app.tools.explain();
      app.commands.send(wave, "Paddle");
      app.tools.wasUsed();
    } else if (isTap) {
      this.tap(at, tool, scale);
    }
  }

  private tap(place: WaterPlace, tool: Tool, scale: ToolScale): void {
    // The server tells a viewer why not.
    if (!this.app.mayDraw) return this.splash(place, undefined);
    const forS = kTapStrokeS[tool.name];
    const size = strokeSize(tool, this.app.entered!, scale);
    if (tool.name === "paddle") this.app.tools.explain();
    else if (forS === undefined || !size) this.splash(place, tool.name === "splash" ? scale : undefined);
    else this.sender.stay(place, size, forS, scale.strengthRatio);
  }

  private splash(place: WaterPlace, scale: ToolScale | undefined): void {
    this.app.commands.send(this.app.effects.splashAt(place, scale), `Splash at ${place.xM.toFixed(1)}, ${place.zM.toFixed(1)} m`);
  }

  private letGo(event: PointerEvent): void {
    if (!this.hands.has(event.pointerId)) return;
    event.stopPropagation();
    this.lift(event.pointerId);
  }

  /** The pointer draws from now on, if its tool draws. */
  private begin(pointerId: number): void {
    const hand = this.hands.get(pointerId);
    if (!hand || hand.draws || !hand.size) return;
    hand.draws = true;
    window.clearTimeout(hand.timer);
    this.taps.cancelled(pointerId);
    this.sender.begin(pointerId, hand.points.splice(0), hand.size);
    this.app.tools.wasUsed();
  }

  private lift(pointerId: number): void {
    const hand = this.hands.get(pointerId);
    if (!hand) return;
    window.clearTimeout(hand.timer);
    this.hands.delete(pointerId);
    this.sender.end(pointerId);
    this.app.display.scene.ripple.lift(pointerId, nowS());
  }

  /** Gives two fingers to the camera, the first of which was ours. */
  private handOver(first: PointerEvent, second: PointerEvent): void {
    this.lift(first.pointerId);
    this.cameraTouchMs = second.timeStamp;
    this.isHandingOver = true;
    this.app.display.canvas.dispatchEvent(new PointerEvent("pointerdown", first));
    this.isHandingOver = false;
  }

  /** What the tool acts on: of the first hand, or of the mouse where it is. A finger has its ring. */
  private outline(): Outline | undefined {
    const { app } = this;
    const [hand] = this.hands.values();
    const at = hand?.at ?? (this.hover && this.placeUnder(this.hover));
    const { tool, scale } = hand ?? app.tools;
    if (!at || !app.entered || tool.name === "finger") return undefined;
    if (tool.name === "paddle") {
      const widthM = paddleWidthM(app.entered.waterExtents.sideM, scale.sizeRatio);
      return hand && { kind: "paddle", from: hand.from, to: at, widthM, color: kOutlineColor };
    }
    const heldS = hand ? (performance.now() - hand.down.timeStamp - kTapMs / 2) / 1000 : 0;
    const radiusM = strokeSize(tool, app.entered, scale)?.radiusM ?? app.effects.splashRadiusM * scale.sizeRatio * heldRatio(heldS);
    return { kind: "disc", at, radiusM, color: kOutlineColor };
  }

  private placeUnder(event: PointerEvent): WaterPlace | undefined {
    const { canvas, scene } = this.app.display;
    const shape = scene.shape();
    if (!shape) return undefined;
    const at = toDeviceCoordinates(event.clientX, event.clientY, canvas.getBoundingClientRect());
    const { camera } = scene;
    const direction = new Vector3(at.x, at.y, 0.5).unproject(camera).sub(camera.position).normalize();
    return pickWater({ originM: camera.position.toArray(), direction: direction.toArray() }, shape);
  }
}

function sampleOf(event: PointerEvent): PointerSample {
  return { id: event.pointerId, xPx: event.clientX, yPx: event.clientY, timeMs: event.timeStamp };
}

/** Only pens tell their pressure well enough. */
function pointOf(event: PointerEvent, place: WaterPlace, { strengthRatio }: ToolScale): FingerPoint {
  const pressureRatio = strengthRatio * (event.pointerType === "pen" && event.pressure > 0 ? event.pressure : 1);
  return { timeMs: event.timeStamp, ...place, pressureRatio };
}
