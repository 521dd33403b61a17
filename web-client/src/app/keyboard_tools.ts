// The tools without a pointer: a cursor over the water, moved by the arrow keys, where Enter or the space bar act as a pointer of their own
// would. It begins where the mouse is, otherwise in the middle. While Enter is held the arrows draw, throw, or move what it holds.
import { make } from "../ui/dom";
import { kGamepadId } from "./haptics";
import { VirtualPointer } from "./virtual_pointer";

const kKeyboardId = kGamepadId + 1;
/** A paddle that is used by a key sends its wave away from the viewer: along this share of the picture's height. */
const kPushShare = 0.12;
const kStepPx = 16;
const kArrows: Record<string, readonly [right: number, down: number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** What the keys act on: the page of the water, or a pad. */
interface KeyboardTarget {
  /** Has the focus, and takes the pointer's events. */
  canvas: HTMLCanvasElement;
  /** The arrows steer a boat. */
  isHelm(): boolean;
  /** The tool sends a wave along a drag. */
  isPaddle(): boolean;
}

export function connectKeyboardTools({ canvas, isHelm, isPaddle }: KeyboardTarget): void {
  const pointer = new VirtualPointer(canvas, kKeyboardId);
  const mark = make("div", { class: "key-cursor", "aria-hidden": "true", "data-testid": "key-cursor", hidden: "" });
  canvas.after(mark);
  /** Where the mouse is, or where the arrows have moved the cursor; undefined: in the middle. */
  let at: [xPx: number, yPx: number] | undefined;
  let isMoved = false;
  const now = (): [number, number] => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    return at ?? [left + width / 2, top + height / 2];
  };
  const show = (isShown: boolean): void => {
    mark.hidden = !isShown;
    const [xPx, yPx] = now();
    mark.style.transform = `translate(${xPx}px, ${yPx}px)`;
  };
  const isUse = ({ code, ctrlKey, altKey, metaKey }: KeyboardEvent): boolean => (code === "Enter" || code === "Space") && !ctrlKey && !altKey && !metaKey;
  canvas.addEventListener("keydown", (event) => {
    if (!isUse(event)) return;
    event.preventDefault();
    // A key that was held before the canvas had the focus has pressed something else.
    if (!pointer.isDown && event.repeat) return;
    if (!pointer.isDown) isMoved = false;
    pointer.press(...now());
  });
  canvas.addEventListener("keydown", (event) => {
    const arrow = event.shiftKey || event.ctrlKey || event.altKey || event.metaKey ? undefined : kArrows[event.code];
    if (!arrow || (isHelm() && !pointer.isDown)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const { left, top, right, bottom } = canvas.getBoundingClientRect();
    const [xPx, yPx] = now();
    at = [Math.min(Math.max(xPx + kStepPx * arrow[0], left), right - 1), Math.min(Math.max(yPx + kStepPx * arrow[1], top), bottom - 1)];
    isMoved = true;
    pointer.move(...at);
    show(true);
  }, { capture: true });
  const release = (): void => {
    const [xPx, yPx] = now();
    const toPx = isPaddle() && !isMoved ? yPx - kPushShare * canvas.clientHeight : yPx;
    if (pointer.isDown && toPx !== yPx) pointer.move(xPx, toPx);
    pointer.release(xPx, toPx);
  };
  canvas.addEventListener("keyup", (event) => isUse(event) && release());
  canvas.addEventListener("blur", () => {
    release();
    show(false);
  });
  // The mouse takes the cursor along; when it leaves the water, the cursor is in the middle again.
  canvas.addEventListener("pointermove", (event) => {
    if (!event.isTrusted || event.pointerType !== "mouse" || pointer.isDown) return;
    at = [event.clientX, event.clientY];
    show(false);
  });
  canvas.addEventListener("pointerleave", (event) => {
    if (event.isTrusted && mark.hidden) at = undefined;
  });
}
