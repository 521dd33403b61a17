// The tools by a gamepad, which acts as a pointer of its own would. keyboard_tools.ts does the same for keys.
//
// Gamepad (the standard mapping): the left stick moves a cursor over the picture, A uses the tool there, held longer or moved on as a finger
// would; LB and RB choose the tool, or turn what is held; X takes out the object there, Y chooses the next kind, B launches a boat. The right stick turns the
// view, the triggers bring it nearer and farther; Back chooses the next view, Start the sound. The D-pad goes through the controls of the page
// (panel_cursor.ts). In the boat's view the left stick and the D-pad are the helm. docs/controls.md lists all.
import type { HelmCode } from "../ui/helm";
import { standardGamepad } from "./gamepad";
import { kGamepadId } from "./haptics";
import { PanelCursor } from "./panel_cursor";

/** Below this a stick counts as released. */
const kDeadZone = 0.15;
/** Speed of the cursor with the stick at its end, in heights of the picture per second. */
const kCursorPerS = 0.6;
const kLongestStepS = 0.1;

/** Turn of what is held, per second. */
const kTurnRadps = 2;

/** The view: turn and zoom per second with a stick or a trigger at its end. */
const kOrbitRadps = 1.8;
const kZoomPerS = 2.5;

const kButtons = { use: 0, launch: 1, takeOut: 2, nextKind: 3, previousTool: 4, nextTool: 5, nearer: 7, farther: 6, nextView: 8, sound: 9, up: 12, down: 13, left: 14, right: 15 };
const kHelm = { up: "ArrowUp", down: "ArrowDown", left: "ArrowLeft", right: "ArrowRight" } as const;

/** Sends the events of a pointer at a position of the window. */
export class VirtualPointer {
  isDown = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly pointerId: number,
  ) {}

  press(xPx: number, yPx: number): void {
    if (this.isDown) return;
    this.isDown = true;
    this.send("pointerdown", xPx, yPx);
  }

  move(xPx: number, yPx: number): void {
    this.send("pointermove", xPx, yPx);
  }

  release(xPx: number, yPx: number): void {
    if (!this.isDown) return;
    this.isDown = false;
    this.send("pointerup", xPx, yPx);
  }

  private send(type: string, clientX: number, clientY: number): void {
    const buttons = this.isDown ? 1 : 0;
    this.canvas.dispatchEvent(new PointerEvent(type, { pointerId: this.pointerId, pointerType: "mouse", button: 0, buttons, clientX, clientY, bubbles: true }));
  }
}

/** What a gamepad acts on: the page of the water, or a pad, which has neither views nor sound. */
export interface GamepadTarget {
  /** Takes the events of the gamepad's pointer. */
  canvas: HTMLCanvasElement;
  /** The sticks steer the boat. */
  isHelm(): boolean;
  /** Presses or releases a key of the helm. */
  helm(code: HelmCode, isDown: boolean): void;
  launch(): void;
  /** The next tool, or the one before. */
  stepTool(by: 1 | -1): void;
  /** False if nothing is held. */
  turnHeld(angleRad: number): boolean;
  removePointed(): void;
  nextKind(): void;
  nextView(): void;
  toggleSound(): void;
  orbit(turnRad: number, liftRad: number, zoom: number): void;
}

export class GamepadTools {
  private readonly pointer: VirtualPointer;
  private xPx = window.innerWidth / 2;
  private yPx = window.innerHeight / 2;
  private isThere = false;
  private held = new Set<number>();
  private readonly helm = new Set<keyof typeof kHelm>();
  private readonly panel = new PanelCursor();
  private atS = NaN;

  constructor(private readonly target: GamepadTarget) {
    this.pointer = new VirtualPointer(target.canvas, kGamepadId);
  }

  /** Where the tool would be used, in pixels of the window; undefined without a gamepad, while it steers, and in the panels. */
  get cursorPx(): [x: number, y: number] | undefined {
    return this.isThere && !this.target.isHelm() && !this.panel.isActive ? [this.xPx, this.yPx] : undefined;
  }

  /** Called for each picture. */
  update(nowS: number): void {
    const pad = standardGamepad();
    const stepS = Math.min(Math.max(nowS - this.atS, 0), kLongestStepS) || 0;
    this.atS = nowS;
    this.isThere = pad !== undefined;
    if (!pad) {
      this.steer({});
      this.held.clear();
      this.panel.leave();
      return this.pointer.release(this.xPx, this.yPx);
    }
    const pressed = new Set(pad.buttons.flatMap((button, k) => (button.pressed ? [k] : [])));
    const isNew = (button: number): boolean => pressed.has(button) && !this.held.has(button);
    const [x = 0, y = 0, turnX = 0, turnY = 0] = pad.axes.map((value) => (Math.abs(value) > kDeadZone ? value : 0));
    const { target } = this;
    const turn = Number(pressed.has(kButtons.nextTool)) - Number(pressed.has(kButtons.previousTool));
    if (!target.turnHeld(turn * kTurnRadps * stepS)) {
      if (isNew(kButtons.previousTool)) target.stepTool(-1);
      if (isNew(kButtons.nextTool)) target.stepTool(1);
    }
    const isHelm = target.isHelm();
    if (isHelm || x !== 0 || y !== 0 || !this.panel.isActive) this.panel.leave();
    if (!isHelm) {
      if (isNew(kButtons.down)) this.panel.move(1);
      if (isNew(kButtons.up)) this.panel.move(-1);
      if (isNew(kButtons.right)) this.panel.change(1);
      if (isNew(kButtons.left)) this.panel.change(-1);
    }
    const isInPanel = this.panel.isActive;
    if (isInPanel && isNew(kButtons.use)) this.panel.press();
    if (isNew(kButtons.launch)) {
      if (isInPanel) this.panel.leave();
      else target.launch();
    }
    if (isNew(kButtons.takeOut)) target.removePointed();
    if (isNew(kButtons.nextKind)) target.nextKind();
    if (isNew(kButtons.nextView)) target.nextView();
    if (isNew(kButtons.sound)) target.toggleSound();
    const zoom = Number(pressed.has(kButtons.farther)) - Number(pressed.has(kButtons.nearer));
    if (turnX !== 0 || turnY !== 0 || zoom !== 0) target.orbit(turnX * kOrbitRadps * stepS, turnY * kOrbitRadps * stepS, kZoomPerS ** (zoom * stepS));
    this.steer(isHelm ? { up: y < 0 || pressed.has(kButtons.up), down: y > 0 || pressed.has(kButtons.down), left: x < 0 || pressed.has(kButtons.left), right: x > 0 || pressed.has(kButtons.right) } : {});
    if (!isHelm && (x !== 0 || y !== 0)) {
      const stepPx = kCursorPerS * stepS * window.innerHeight;
      this.xPx = Math.min(Math.max(this.xPx + x * stepPx, 0), window.innerWidth - 1);
      this.yPx = Math.min(Math.max(this.yPx + y * stepPx, 0), window.innerHeight - 1);
      this.pointer.move(this.xPx, this.yPx);
    }
    if (isNew(kButtons.use) && !isInPanel) this.pointer.press(this.xPx, this.yPx);
    else if (!pressed.has(kButtons.use)) this.pointer.release(this.xPx, this.yPx);
    this.held = pressed;
  }

  private steer(wanted: Partial<Record<keyof typeof kHelm, boolean>>): void {
    for (const key of Object.keys(kHelm) as (keyof typeof kHelm)[]) {
      if (wanted[key] === true === this.helm.has(key)) continue;
      this.target.helm(kHelm[key], wanted[key] === true);
      if (wanted[key]) this.helm.add(key);
      else this.helm.delete(key);
    }
  }
}
