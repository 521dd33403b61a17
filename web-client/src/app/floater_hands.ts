// Objects that pointers take hold of: which one is under a pointer, where it is pulled to, how the wheel or a second finger turns it, and
// what takes it out of the water. pointer.ts decides when a press is a hold.
import type { FloaterPose } from "../../client/codec/floaters";
import { kRadiusSizes } from "../scene/frames/floaters";
import { pickFloater } from "../scene/frames/pick_floater";
import { clamp, wrapAngle } from "../scene/maths/interpolate";
import { byId } from "../ui/dom";
import { HoldSender, kHoldLabel, type HoldMessage } from "../ui/hold_sender";
import { kPageTime } from "../ui/latest_sender";
import type { Outline } from "../ui/tool_preview";
import type { ToolName, WaterPlace } from "../ui/tools";
import type { App } from "./app";
import { rayAt } from "./pointer_ray";
import { kTexts } from "../ui/texts";

/** An object counts as hit within this distance of a pointer; a finger covers more than a mouse's arrow. */
const kNearPx = { touch: 22, other: 6 };
/** A sunken object, that is so much of its size below the surface, is only taken with the tool for objects. */
const kSunkenSizes = 0.6;
/** Of the wheel: turn per pixel, and the most that one event counts. */
const kWheelRadPerPx = 0.004;
const kWheelMostPx = 120;
/** Pixels of a line, which some browsers count in. */
const kLinePx = 16;
const kOutlineColor = "#5fd4e6";

/** Where a pointer is in the window. */
export type PointerAt = Pick<PointerEvent, "clientX" | "clientY" | "pointerType">;

/** An object at the moment when it was touched. */
export interface Grip {
  floaterId: number;
  /** Of its middle. It is moved in this plane. */
  yM: number;
  /** From the pointer to its middle. */
  offset: WaterPlace;
  at: WaterPlace;
}

/** Two fingers, the first of which holds. */
interface Twist {
  ownerId: number;
  partnerId: number;
  owner: PointerAt;
  partner: PointerAt;
}

export class FloaterHands {
  private readonly sender: HoldSender;
  private readonly bin = byId<HTMLButtonElement>("bin");
  private twist: Twist | undefined;
  /** Pointers that have been beside the bin since they hold: it appears under some. */
  private readonly beside = new Set<number>();

  /** `lost`: this pointer's object is held no longer, because the server refused it. */
  constructor(
    private readonly app: App,
    private readonly lost: (pointerId: number) => void,
  ) {
    const send = (value: HoldMessage): number => (app.mayDraw ? app.commands.send({ case: "holdFloater", value }, kHoldLabel) : 0);
    this.sender = new HoldSender(send, (pointerId) => this.left(pointerId), kPageTime);
    app.answerListeners.push({ ack: (commandId) => this.sender.answered(commandId, false), reject: (commandId) => this.sender.answered(commandId, true) });
    // Before the camera, which the wheel brings nearer.
    app.display.canvas.addEventListener("wheel", (event) => this.wheeled(event), { capture: true, passive: false });
    this.bin.addEventListener("click", () => this.removeHeld());
    app.turnHeld = (angleRad) => this.turn(angleRad);
  }

  /** Returns the object under a pointer that a press with this tool would hold. */
  under(pointer: PointerAt, tool: ToolName): Grip | undefined {
    if (!this.app.hasFloaters || this.app.lessons.whyNot("float") !== undefined || (tool !== "finger" && tool !== "float")) return undefined;
    const pose = this.poseUnder(pointer, tool === "float");
    if (!pose) return undefined;
    const { floaterId, xM, yM, zM } = pose;
    const at = this.onPlane(pointer, yM) ?? { xM, zM };
    return { floaterId, yM, at: { xM, zM }, offset: { xM: xM - at.xM, zM: zM - at.zM } };
  }

  /** Holds an object from now on; `pointerNow` is where the pointer was last. */
  hold(pointerId: number, grip: Grip, pointerNow: () => PointerAt): void {
    let last = grip.at;
    this.sender.begin(pointerId, grip.floaterId, () => (last = this.placeOf(grip, pointerNow()) ?? last));
    this.bin.hidden = false;
    this.app.haptics.feel("catch", { pointerId, pointerType: pointerNow().pointerType });
    if (!this.isOverBin(pointerNow())) this.beside.add(pointerId);
  }

  isHolding(pointerId: number): boolean {
    return this.sender.heldBy(pointerId) !== 0;
  }

  /** Lets go; over the bin, the object is taken out of the water. */
  end(pointerId: number, pointer?: PointerAt): void {
    if (!this.isHolding(pointerId)) return;
    if (pointer && this.beside.delete(pointerId) && this.isOverBin(pointer)) this.remove(this.sender.heldBy(pointerId));
    else this.sender.end(pointerId);
    if (pointer) this.app.haptics.feel("letGo", { pointerId, pointerType: pointer.pointerType });
    this.refresh();
  }

  /** A second finger comes down beside one that holds: together they turn. */
  beginTwist(ownerId: number, owner: PointerAt, partnerId: number, partner: PointerAt): void {
    this.twist ??= { ownerId, owner, partnerId, partner };
  }

  /** True for the second finger. */
  isTwisting(pointerId: number): boolean {
    return this.twist?.partnerId === pointerId;
  }

  /** Follows both fingers of a twist, and none else. */
  moved(pointerId: number, pointer: PointerAt): void {
    if (this.isHolding(pointerId) && !this.isOverBin(pointer)) this.beside.add(pointerId);
    const { twist } = this;
    if (!twist || (pointerId !== twist.ownerId && pointerId !== twist.partnerId)) return;
    const before = angleOf(twist);
    if (pointerId === twist.ownerId) twist.owner = pointer;
    else twist.partner = pointer;
    this.sender.turn(wrapAngle(angleOf(twist) - before), twist.ownerId);
  }

  endTwist(): void {
    this.twist = undefined;
  }

  /** Takes an object out of the water. */
  remove(floaterId: number): void {
    this.app.commands.send({ case: "removeFloater", value: { floaterId } }, kTexts.commands.removeObject);
    for (const pointerId of this.sender.pointers()) if (this.sender.heldBy(pointerId) === floaterId) this.sender.drop(pointerId);
    this.refresh();
  }

  /** Holds nothing any more, and says nothing. */
  forget(): void {
    for (const pointerId of this.sender.pointers()) this.sender.drop(pointerId);
    this.refresh();
  }

  /** Takes out what is held; false if nothing is. */
  removeHeld(): boolean {
    const pointerId = this.sender.pointers().at(-1);
    if (pointerId === undefined) return false;
    this.remove(this.sender.heldBy(pointerId));
    this.lost(pointerId);
    return true;
  }

  /** A ring round an object, as the mouse passes over it. */
  outlineOf({ floaterId }: Grip): Outline | undefined {
    const pose = this.app.display.scene.drawnFloaters().find((each) => each.floaterId === floaterId);
    return pose && { kind: "disc", at: { xM: pose.xM, zM: pose.zM }, radiusM: kRadiusSizes[pose.kind] * pose.sizeM, color: kOutlineColor };
  }

  private left(pointerId: number): void {
    this.refresh();
    this.lost(pointerId);
  }

  private refresh(): void {
    const isHolding = this.sender.pointers().length > 0;
    this.bin.hidden = !isHolding;
    if (!isHolding) this.beside.clear();
    if (this.twist && !this.isHolding(this.twist.ownerId)) this.twist = undefined;
  }

  /** Turns what was taken last; false if nothing is held. */
  private turn(angleRad: number): boolean {
    const pointerId = this.sender.pointers().at(-1);
    if (pointerId !== undefined) this.sender.turn(angleRad, pointerId);
    return pointerId !== undefined;
  }

  private wheeled(event: WheelEvent): void {
    const px = (event.deltaY || event.deltaX) * (event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : kLinePx);
    if (!this.turn(kWheelRadPerPx * clamp(px, -kWheelMostPx, kWheelMostPx))) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }

  private isOverBin({ clientX, clientY }: PointerAt): boolean {
    const { left, right, top, bottom } = this.bin.getBoundingClientRect();
    return !this.bin.hidden && clientX >= left && clientX <= right && clientY >= top && clientY <= bottom;
  }

  private poseUnder({ clientX, clientY, pointerType }: PointerAt, takesSunken: boolean): FloaterPose | undefined {
    const { display } = this.app;
    const { canvas, scene } = display;
    const nearPx = pointerType === "touch" ? kNearPx.touch : kNearPx.other;
    const nearRad = (2 * Math.tan((scene.camera.fov * Math.PI) / 360) * nearPx) / Math.max(canvas.clientHeight, 1);
    const accepts = ({ xM, yM, zM, sizeM }: FloaterPose): boolean => takesSunken || yM + kSunkenSizes * sizeM > scene.heightAtM(xM, zM);
    return pickFloater(rayAt(display, clientX, clientY), scene.drawnFloaters(), nearRad, accepts);
  }

  /** Where the object is to be, over the water. */
  private placeOf({ yM, offset }: Grip, pointer: PointerAt): WaterPlace | undefined {
    const at = this.onPlane(pointer, yM);
    const { sideM, widthM } = this.app.entered!;
    return at && { xM: clamp(at.xM + offset.xM, -sideM / 2, sideM / 2), zM: clamp(at.zM + offset.zM, -widthM / 2, widthM / 2) };
  }

  private onPlane({ clientX, clientY }: PointerAt, yM: number): WaterPlace | undefined {
    const { originM, direction } = rayAt(this.app.display, clientX, clientY);
    const wayM = (yM - originM[1]) / direction[1];
    return wayM > 0 && Number.isFinite(wayM) ? { xM: originM[0] + wayM * direction[0], zM: originM[2] + wayM * direction[2] } : undefined;
  }
}

/** On the screen, clockwise. */
function angleOf({ owner, partner }: Twist): number {
  return Math.atan2(partner.clientY - owner.clientY, partner.clientX - owner.clientX);
}
