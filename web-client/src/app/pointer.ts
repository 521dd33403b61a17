// Pointers on the canvas: a tap, a drag or a long press on the water uses the tool, each finger for itself; everything else is left to the
// camera: the right button, two fingers that come down together, a drag that begins off the water. A drag that begins on an object holds it
// (floater_hands.ts).
import { kClickRadiusPx } from "../scene/camera/camera_hand";
import { kPageTime } from "../ui/latest_sender";
import { kStrokeLabel, StrokeSender, type FingerPoint, type StrokeMessage } from "../ui/stroke_sender";
import { arcOf, dropOf, flickOf, floaterSizeM, throwOf, tossTo, type Throw } from "../ui/floater_tools";
import { kTapMs, TapDetector, type PointerSample } from "../ui/tap";
import { lessonToolOf } from "../ui/lesson_state";
import type { Outline } from "../ui/tool_preview";
import { heldRatio, kTapStrokeS, paddleWave, paddleWidthM, strokeSize, type StrokeSize, type Tool, type ToolScale, type WaterPlace } from "../ui/tools";
import type { App } from "./app";
import { FloaterHands, type Grip } from "./floater_hands";
import { nowS } from "./picture_clock";
import { waterUnder } from "./pointer_ray";
import { kTexts } from "../ui/texts";

/** Two fingers that come down within this time are a gesture of the camera. */
const kTogetherMs = 150;
const kOutlineColor = "#ffffff";
/** Radius of the ring where a gauge is placed, as a share of the shorter side. */
const kPlaceSides = 0.02;

/** A pointer that began on the water. */
interface Hand {
  down: PointerEvent;
  /** Its newest event. */
  last: PointerEvent;
  /** The object under it, which a drag holds. */
  grip: Grip | undefined;
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
  /** Begins the stroke, or the hold, of a finger that is held still. */
  timer: number;
}

export class PointerHands {
  private readonly taps = new TapDetector();
  private readonly hands = new Map<number, Hand>();
  private readonly sender: StrokeSender;
  private readonly floaters: FloaterHands;
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
    this.sender = new StrokeSender(send, kPageTime);
    this.floaters = new FloaterHands(app, (pointerId) => this.lift(pointerId));
    app.removePointed = () => this.removePointed();
    const { canvas } = app.display;
    // Before the camera, which listens to the same canvas and, while it turns, to the document.
    canvas.addEventListener("pointerdown", (event) => this.pressed(event), { capture: true });
    document.addEventListener("pointerdown", () => (app.display.views.takesPointers = true));
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("pointerup", (event) => this.released(event));
    canvas.addEventListener("pointerleave", () => (this.hover = undefined));
    canvas.addEventListener("pointercancel", (event) => {
      this.taps.cancelled(event.pointerId);
      if (this.floaters.isTwisting(event.pointerId)) this.floaters.endTwist();
      this.letGo(event, true);
    });
    app.outline = () => this.outline();
  }

  /** Lifts all fingers. `isNewWater`: what they held is gone. */
  liftAll(isNewWater = false): void {
    if (isNewWater) this.floaters.forget();
    for (const pointerId of [...this.hands.keys()]) this.lift(pointerId);
  }

  private pressed(event: PointerEvent): void {
    if (this.isHandingOver) return;
    // The camera knows the browser's pointers only.
    if (!event.isTrusted) this.app.display.views.takesPointers = false;
    this.hover = undefined;
    if (event.button === 0) this.taps.pressed(sampleOf(event));
    const { app, hands } = this;
    // Its tap places, and a drag turns the view.
    if (app.placing) return;
    const isTouch = event.pointerType === "touch";
    // Keys and gamepads have no other use.
    const isFirst = app.drawing.drawsFirst || !event.isTrusted;
    if (!app.mayDraw || event.button !== (isFirst ? 0 : 2) || (isTouch && !isFirst)) return;
    if (isTouch && this.twist(event)) return;
    const partner = isTouch ? [...hands.values()].find(({ down, draws }) => !draws && event.timeStamp - down.timeStamp < kTogetherMs && down.pointerType === "touch") : undefined;
    if (partner) return this.handOver(partner.down, event);
    const { tool } = app.tools;
    const grip = this.floaters.under(event, tool.name);
    const place = this.placeUnder(event) ?? grip?.at;
    if (!place || (isTouch && event.timeStamp - this.cameraTouchMs < kTogetherMs)) {
      if (isTouch) this.cameraTouchMs = event.timeStamp;
      return;
    }
    const reason = grip ? undefined : this.whyNot(tool);
    if (reason !== undefined) return app.tools.explain(reason);
    app.display.views.takesPointers = false;
    // Those of keys and gamepads exist for this page only.
    if (event.isTrusted) app.display.canvas.setPointerCapture(event.pointerId);
    const scale = { ...app.tools.scale };
    const size = grip ? undefined : strokeSize(tool, app.entered!, scale);
    if (size && tool.name === "finger") app.display.scene.ripple.press(event.pointerId, place.xM, place.zM, size, nowS());
    const timer = window.setTimeout(() => this.heldStill(event.pointerId), kTapMs);
    hands.set(event.pointerId, { down: event, last: event, grip, tool, scale, size, from: place, at: place, points: [pointOf(event, place, scale)], draws: false, timer });
  }

  private moved(event: PointerEvent): void {
    const hand = this.hands.get(event.pointerId);
    this.floaters.moved(event.pointerId, event);
    if (!hand) {
      if (event.pointerType === "mouse") this.hover = event.buttons === 0 ? event : undefined;
      return;
    }
    event.stopPropagation();
    hand.last = event;
    // Browsers tell of them in secure contexts only.
    const coalesced = event.getCoalescedEvents?.() ?? [];
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
    if (this.floaters.isTwisting(event.pointerId)) {
      this.floaters.endTwist();
      return this.taps.cancelled(event.pointerId);
    }
    const isTap = this.taps.released(sampleOf(event));
    const hand = this.hands.get(event.pointerId);
    this.letGo(event);
    if (event.pointerType === "mouse") this.hover = event;
    if (hand) return this.use(hand, isTap, event.timeStamp - hand.down.timeStamp);
    const place = isTap ? this.placeUnder(event) : undefined;
    if (place && this.app.placing) return this.app.placing(place);
    if (place) this.tap(place, this.app.tools.tool, this.app.tools.scale, event);
  }

  /** A press with a tool has ended. */
  private use(hand: Hand, isTap: boolean, heldMs: number): void {
    const { app } = this;
    const { tool, scale, from, at, down } = hand;
    if (!app.mayDraw || (hand.grip && !isTap)) return;
    if (tool.name === "splash") {
      this.splash(at, { ...scale, sizeRatio: scale.sizeRatio * heldRatio((heldMs - kTapMs / 2) / 1000) }, down);
    } else if (tool.name === "paddle") {
      const wave = paddleWave(from, at, app.entered!, scale);
      if (!wave) return app.tools.explain();
      app.commands.send(wave, kTexts.commands.paddle);
      app.tools.wasUsed();
    } else if (tool.name === "throw") {
      this.launch(this.throwOf(hand, isTap), scale);
    } else if (tool.name === "float") {
      this.drop(at, scale);
    } else if (isTap) {
      this.tap(at, tool, scale, down);
    }
  }

  private tap(place: WaterPlace, tool: Tool, scale: ToolScale, by: PointerEvent): void {
    const reason = this.whyNot(tool);
    if (reason !== undefined) return this.app.tools.explain(reason);
    // The server tells a viewer why not.
    if (!this.app.mayDraw) return this.splash(place, undefined, by);
    const forS = kTapStrokeS[tool.name];
    const size = strokeSize(tool, this.app.entered!, scale);
    if (tool.name === "paddle") this.app.tools.explain();
    else if (tool.name === "float") this.drop(place, scale);
    else if (tool.name === "throw") this.launch(this.tossTo(place), scale);
    else if (forS === undefined || !size) this.splash(place, tool.name === "splash" ? scale : undefined, by);
    else this.sender.stay(place, size, forS, scale.strengthRatio);
  }

  /** Returns why the lesson withholds a tool; undefined if it does not. */
  private whyNot({ name }: Tool): string | undefined {
    return this.app.lessons.whyNot(lessonToolOf(name));
  }

  private splash(place: WaterPlace, scale: ToolScale | undefined, by: PointerEvent): void {
    if (this.app.mayDraw) this.app.haptics.feel("splash", by);
    this.app.commands.send(this.app.effects.splashAt(place, scale), kTexts.commands.splash);
    this.app.tools.wasUsed();
  }

  private letGo(event: PointerEvent, isCancelled = false): void {
    if (!this.hands.has(event.pointerId)) return;
    event.stopPropagation();
    this.floaters.end(event.pointerId, isCancelled ? undefined : event);
    this.lift(event.pointerId);
  }

  /** A press has not moved. */
  private heldStill(pointerId: number): void {
    const hand = this.hands.get(pointerId);
    if (!hand?.grip || hand.tool.name !== "float") return this.begin(pointerId);
    const { floaterId } = hand.grip;
    // Moves that a busy page has not heard of come before its next picture.
    requestAnimationFrame(() => {
      if (this.hands.get(pointerId) !== hand || hand.draws) return;
      this.taps.cancelled(pointerId);
      this.floaters.remove(floaterId);
      this.lift(pointerId);
      this.app.tools.wasUsed();
    });
  }

  /** True for a second finger beside one that holds an object, or that has been on one for a while. */
  private twist(event: PointerEvent): boolean {
    const owner = [...this.hands].find(([, { grip, draws, down }]) => grip && down.pointerType === "touch" && (draws || event.timeStamp - down.timeStamp >= kTogetherMs));
    if (!owner) return false;
    const [ownerId, { last }] = owner;
    this.begin(ownerId);
    this.app.display.views.takesPointers = false;
    this.floaters.beginTwist(ownerId, last, event.pointerId, event);
    return true;
  }

  private removePointed(): void {
    const { app, hover, floaters } = this;
    if (floaters.removeHeld()) return;
    const middle = { clientX: window.innerWidth / 2, clientY: window.innerHeight / 2, pointerType: "mouse" };
    const pointer = hover ?? (app.display.canvas.matches(":focus-visible") ? middle : undefined);
    const grip = pointer && floaters.under(pointer, "float");
    if (grip) floaters.remove(grip.floaterId);
  }

  private drop(place: WaterPlace, scale: ToolScale): void {
    const { app } = this;
    const { kind, densityRatio } = app.floaterRows;
    const sizeM = floaterSizeM("float", app.entered!, scale)!;
    const headingDeg = Math.round(360 * Math.random() - 180);
    app.commands.send(dropOf(kind, place, app.display.scene.heightAtM(place.xM, place.zM), sizeM, densityRatio, headingDeg, app.entered!), kTexts.kinds[kind]);
    app.tools.wasUsed();
  }

  private launch(thrown: Throw | undefined, scale: ToolScale): void {
    const { app } = this;
    if (!thrown) return app.tools.explain();
    app.commands.send(throwOf(thrown, floaterSizeM("throw", app.entered!, scale)!, app.entered!), kTexts.commands.stone);
    app.tools.wasUsed();
  }

  private tossTo(target: WaterPlace): Throw {
    const { entered, display: { scene } } = this.app;
    const { x: xM, z: zM } = scene.camera.position;
    return tossTo(target, { xM, zM }, scene.heightAtM(target.xM, target.zM), entered!);
  }

  /** The throw of a hand that lets go now. */
  private throwOf({ from, at, down, last, scale }: Hand, isTap: boolean): Throw | undefined {
    const { entered, display: { scene } } = this.app;
    const isFlick = !isTap && Math.hypot(last.clientX - down.clientX, last.clientY - down.clientY) > kClickRadiusPx;
    return isFlick ? flickOf(from, at, (performance.now() - down.timeStamp) / 1000, scene.heightAtM(from.xM, from.zM), entered!, scale) : this.tossTo(at);
  }

  /** The pointer draws from now on, if its tool draws. */
  private begin(pointerId: number): void {
    const hand = this.hands.get(pointerId);
    if (!hand || hand.draws || (!hand.size && !hand.grip)) return;
    hand.draws = true;
    window.clearTimeout(hand.timer);
    this.taps.cancelled(pointerId);
    if (hand.grip) this.floaters.hold(pointerId, hand.grip, () => hand.last);
    if (hand.size) this.sender.begin(pointerId, hand.points.splice(0), hand.size);
    this.app.tools.wasUsed();
  }

  private lift(pointerId: number): void {
    const hand = this.hands.get(pointerId);
    if (!hand) return;
    window.clearTimeout(hand.timer);
    this.hands.delete(pointerId);
    this.sender.end(pointerId);
    this.floaters.end(pointerId);
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
    const { tool, scale } = hand ?? app.tools;
    const grip = hand?.grip ?? (!hand && this.hover && !app.placing ? this.floaters.under(this.hover, tool.name) : undefined);
    if (grip) return this.floaters.outlineOf(grip);
    const at = hand?.at ?? (this.hover && this.placeUnder(this.hover));
    if (at && app.entered && app.placing) return { kind: "disc", at, radiusM: kPlaceSides * app.entered.waterExtents.sideM, color: kOutlineColor };
    if (!at || !app.entered || tool.name === "finger") return undefined;
    if (tool.name === "paddle") {
      const widthM = paddleWidthM(app.entered.waterExtents.sideM, scale.sizeRatio);
      return hand && { kind: "paddle", from: hand.from, to: at, widthM, color: kOutlineColor };
    }
    const sizeM = floaterSizeM(tool.name, app.entered, scale);
    if (sizeM !== undefined && tool.name === "throw") {
      const thrown = hand ? this.throwOf(hand, false) : this.tossTo(at);
      return thrown && { kind: "arc", points: arcOf(thrown, app.display.scene.heightAtM(at.xM, at.zM), app.entered), radiusM: sizeM, color: kOutlineColor };
    }
    if (sizeM !== undefined) return { kind: "disc", at, radiusM: sizeM / 2, color: kOutlineColor };
    const heldS = hand ? (performance.now() - hand.down.timeStamp - kTapMs / 2) / 1000 : 0;
    const radiusM = strokeSize(tool, app.entered, scale)?.radiusM ?? app.effects.splashRadiusM * scale.sizeRatio * heldRatio(heldS);
    return { kind: "disc", at, radiusM, color: kOutlineColor };
  }

  private placeUnder(event: PointerEvent): WaterPlace | undefined {
    return waterUnder(this.app.display, event.clientX, event.clientY);
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
