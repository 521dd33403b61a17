// `?class`: the page as a projector shows it to a class. Controls are hidden until the mouse moves; the camera follows the action by itself;
// the address of the pads, the people and the game lie over the water.
import { Vector3 } from "three";

import { beginDirecting, direct, type DirectorState, type Sight } from "../class/director";
import { Boards, playersOf } from "../class/boards";
import { JoinCard, joinAddresses } from "../class/join_card";
import "../class/class.css";
import { standingOut } from "../class/splash_sense";
import { clamp, smooth } from "../scene/maths/interpolate";
import { byId } from "../ui/dom";
import type { App } from "./app";

/** Controls stay for so long after the mouse has moved. */
const kAwakeMs = 4000;
/** Hands on the camera keep it for so long; then it moves back in this time. */
const kHandsS = 25;
const kReturnS = 3;
/** Objects that move faster are looked at [m/s]. */
const kFloaterMps = 0.6;
const kSplashEveryS = 0.5;

export function openProjector(app: App): void {
  document.body.classList.add("projector");
  if (!document.body.classList.contains("panel-closed")) byId("panel-toggle").click();
  const boards = new Boards(app.lessons);
  const card = new JoinCard();
  byId("view").after(boards.element, card.element);
  app.display.keepClearOf(boards.side);
  joinAddresses(location.search, app.token).then(
    (addresses) => card.show(addresses),
    (error: unknown) => app.warn(error instanceof Error ? error.message : String(error)),
  );
  app.lessons.watch(() => card.setPlayers(playersOf(app.lessons).length === 0));
  wakeControls();
  const camera = new DirectedCamera(app);
  const before = app.poll;
  app.poll = (atS) => {
    before(atS);
    boards.update(app.simTimeS);
    camera.update(atS);
  };
}

/** Shows the controls while the mouse moves, or is on them. */
function wakeControls(): void {
  let timer = 0;
  const rest = (): void => {
    if (document.querySelector("#panel:hover, #actions:hover, #tools:hover, #panel :focus-visible")) timer = window.setTimeout(rest, kAwakeMs);
    else document.body.classList.remove("awake");
  };
  const wake = (): void => {
    document.body.classList.add("awake");
    window.clearTimeout(timer);
    timer = window.setTimeout(rest, kAwakeMs);
  };
  for (const type of ["pointermove", "pointerdown", "keydown"] as const) window.addEventListener(type, wake);
}

class DirectedCamera {
  private state: DirectorState | undefined;
  private handsUntilS = -Infinity;
  private atS = 0;
  /** Where hands have left the camera. */
  private left: { eyeM: Vector3; targetM: Vector3; sinceS: number } | undefined;
  private readonly floatersBefore = new Map<number, { xM: number; zM: number; timeS: number; speedMps: number }>();
  private splash: { at: Sight["splash"]; seenS: number } = { at: undefined, seenS: -Infinity };
  private room: unknown;
  /** Who wants no motion sees the whole water. */
  private readonly isStill = window.matchMedia("(prefers-reduced-motion: reduce)");

  constructor(private readonly app: App) {
    const hold = (): void => void (this.handsUntilS = this.atS + kHandsS);
    const { canvas } = app.display;
    for (const type of ["pointerdown", "wheel", "keydown"] as const) canvas.addEventListener(type, hold, { passive: true });
    for (const button of document.querySelectorAll(".views button")) button.addEventListener("click", hold);
    app.display.views.turned = hold;
  }

  update(atS: number): void {
    this.atS = atS;
    const { app } = this;
    const { entered, display } = app;
    if (!entered) return;
    if (atS < this.handsUntilS || display.views.view === "boat") {
      this.state = undefined;
      this.left = { eyeM: display.scene.camera.position.clone(), targetM: display.views.targetM, sinceS: atS };
      return;
    }
    const room = `${entered.room} ${entered.sceneName}`;
    const isNew = this.room !== room;
    this.room = room;
    if (isNew) this.floatersBefore.clear();
    const sight = this.see(atS);
    this.state = this.state && !isNew && !this.isStill.matches ? direct(this.state, sight) : beginDirecting(sight);
    const { positionM, targetM } = display.views.frame(this.state.now);
    const back = this.left && !this.isStill.matches ? smooth(clamp((atS - this.left.sinceS) / kReturnS, 0, 1)) : 1;
    if (this.left && back < 1) {
      positionM.lerpVectors(this.left.eyeM, positionM.clone(), back);
      targetM.lerpVectors(this.left.targetM, targetM.clone(), back);
    }
    display.views.place(positionM.toArray(), targetM.toArray());
  }

  private see(nowS: number): Sight {
    const { entered, display: { scene }, lessons, fingers } = this.app;
    const { game } = lessons;
    const floaters = scene.drawnFloaters();
    const moved = floaters.filter((pose) => pose.isHeld || this.speedOf(pose, nowS) > kFloaterMps);
    if (nowS - this.splash.seenS > kSplashEveryS) {
      const surface = scene.newestSurface();
      this.splash = { at: surface && standingOut(surface), seenS: nowS };
    }
    return {
      nowS,
      sideM: entered!.sideM,
      widthM: entered!.widthM,
      boats: scene.drawnBoats(),
      racerBoatIds: (game?.racers ?? []).map(({ personId }) => lessons.personOf(personId)?.boatIds[0] ?? 0),
      fingers: fingers.list,
      movedFloaters: moved,
      splash: this.splash.at,
      game,
      ball: floaters.find(({ floaterId }) => floaterId === game?.ballFloaterId),
      marks: entered!.course?.marks ?? [],
      goals: Object.values(entered!.course?.goals ?? {}),
    };
  }

  private speedOf({ floaterId, xM, zM }: { floaterId: number; xM: number; zM: number }, nowS: number): number {
    const before = this.floatersBefore.get(floaterId);
    if (before && nowS - before.timeS < kSplashEveryS) return before.speedMps;
    const speedMps = before ? Math.hypot(xM - before.xM, zM - before.zM) / (nowS - before.timeS) : 0;
    this.floatersBefore.set(floaterId, { xM, zM, timeS: nowS, speedMps });
    return speedMps;
  }
}
