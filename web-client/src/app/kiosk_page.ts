// `?kiosk`: the page of an exhibit. It attracts with a camera that moves, lets visitors play within limits, and returns by itself; nothing
// leads out of it. It watches over itself, too.
import "../kiosk/kiosk.css";
import { attractEye } from "../kiosk/attract_camera";
import { lockPage } from "../kiosk/locked_page";
import { kioskOptions } from "../kiosk/options";
import { Visit, type Phase } from "../kiosk/visit";
import { VisitorLimits } from "../kiosk/visitor_limits";
import { Watchdog } from "../kiosk/watchdog";
import { sessionStorageIfAny } from "../net/identity_store";
import { byId, make, setText } from "../ui/dom";
import { kKioskTexts } from "../ui/kiosk_texts";
import type { App } from "./app";
import { nowS } from "./picture_clock";

const kReloadsKey = "spindrift-kiosk-reloads";
const kTickMs = 250;
/** A refused connection is tried again so often: the room may be opened again. */
const kRefusedEveryMs = 15_000;
/** A boat is asked for removal so often until it is gone. */
const kPutAwayEveryMs = 2000;
/** The move back to the first view ends before the camera swings. */
const kReturnS = 1.2;
/** What a visitor does; the mouse alone does not count, which a table that is bumped moves. */
const kInputs = ["pointerdown", "pointermove", "wheel", "keydown"] as const;

/** `app` undefined: the browser has no WebGL now, and only the watchdog runs. */
export function openKiosk(app: App | undefined): void {
  const guard = new Guard(app);
  const kiosk = app && new Kiosk(app, () => guard.pictureDrawn());
  const skippedMs = { visit: 0, watchdog: 0 };
  const updateVisit = (): void => kiosk?.update(performance.now() + skippedMs.visit);
  const updateGuard = (): void => guard.update(performance.now() + skippedMs.watchdog);
  // At once: the tools of a visit must not be seen until the first tick.
  updateVisit();
  window.setInterval(() => {
    updateVisit();
    updateGuard();
  }, kTickMs);
  const skip = (clock: keyof typeof skippedMs, update: () => void, s: number): void => {
    for (let n = 0; n < s; ++n) {
      skippedMs[clock] += 1000;
      update();
    }
  };
  // Measured values, and seconds that pass at once for the time-outs or for the watchdog: for tests and the browser's console.
  const hooks = {
    stats: () => ({ ...kiosk?.stats(), reloads: guard.reloads }),
    skipVisit: (s: number) => skip("visit", updateVisit, s),
    skipWatchdog: (s: number) => skip("watchdog", updateGuard, s),
  };
  Object.defineProperty(window, "spindriftKiosk", { value: Object.freeze(hooks) });
}

class Kiosk {
  private readonly visit: Visit;
  private readonly limits = new VisitorLimits();
  private readonly invite = make("p", { class: "glass kiosk-line kiosk-invite", "data-testid": "kiosk-invite" }, [kKioskTexts.invite]);
  private readonly countdown = make("p", { class: "glass kiosk-line kiosk-countdown", "data-testid": "kiosk-countdown", role: "timer", hidden: "" });
  private readonly view = make("button", { type: "button", class: "glass", "data-testid": "kiosk-view", hidden: "" });
  private shown: Phase | undefined;
  private nowMs = 0;
  private attractFromS = 0;
  private boatId = 0;
  private retriedMs = 0;
  private putAwayMs = -Infinity;
  private room = "";

  constructor(private readonly app: App, drawn: () => void) {
    const { idleS, problem } = kioskOptions(location.search);
    this.visit = new Visit(idleS);
    if (problem) {
      app.warn(problem);
      console.warn(`spindrift: ${problem}`);
    }
    document.body.classList.add("kiosk");
    if (!document.body.classList.contains("panel-closed")) byId("panel-toggle").click();
    byId("tools").append(byId("wave"), byId("spawn"), this.view);
    byId("wave").classList.add("glass");
    byId("spawn").classList.add("glass");
    byId("tools").after(this.invite, this.countdown);
    this.view.addEventListener("click", () => byId(document.body.classList.contains("boat-view") ? "view-start" : "view-boat").click());
    lockPage((digit) => byId("tools").querySelectorAll<HTMLElement>("[data-testid^=tool-]")[digit - 1]?.offsetParent !== null);
    for (const type of kInputs) window.addEventListener(type, (event) => this.touched(event), { capture: true, passive: true });
    app.commands.accepts = (action) => this.limits.takes(action, this.ownBoatIds, this.nowMs);
    app.answerListeners.push({
      ack: (_commandId, _boatId, floaterId) => {
        if (floaterId === 0) return;
        for (const tooMany of this.limits.added(floaterId)) this.removeFloater(tooMany);
      },
      reject: () => {},
    });
    // Gamepads, which can leave the tools, are not asked.
    app.poll = () => {
      drawn();
      this.moveCamera();
    };
    app.display.resize();
  }

  stats() {
    const { limits, visit, nowMs } = this;
    return { phase: visit.phase, secondsLeft: visit.secondsLeft(nowMs), ownFloaters: [...limits.floaterIds], ownBoats: this.ownBoatIds, refusedCount: limits.refusedCount };
  }

  update(nowMs: number): void {
    this.nowMs = nowMs;
    const { app, visit } = this;
    visit.update(nowMs);
    if (visit.phase !== this.shown) this.enterPhase(visit.phase);
    if (visit.phase === "countdown") setText(this.countdown, kKioskTexts.countdown(visit.secondsLeft(nowMs)));
    // Ids belong to one water.
    const room = `${app.entered?.room} ${app.entered?.sceneName}`;
    if (room !== this.room) this.limits.floaterIds.length = 0;
    this.room = room;
    if (app.state.name === "refused" && nowMs - this.retriedMs >= kRefusedEveryMs) {
      this.retriedMs = nowMs;
      app.client.call("retryNow");
    }
    this.followBoat();
    // A boat that comes back with the page, or whose removal was lost.
    if (visit.phase === "attract" && app.state.name === "live") this.putAway();
  }

  private get ownBoatIds(): number[] {
    const { lessons, boats } = this.app;
    return [...new Set([...(lessons.me?.boatIds ?? []), ...(boats.mineId ? [boats.mineId] : [])])];
  }

  private touched(event: Event): void {
    if (event instanceof PointerEvent && event.type === "pointermove" && event.buttons === 0) return;
    this.visit.touched(this.nowMs);
    this.enterPhase("active");
  }

  private enterPhase(phase: Phase): void {
    const before = this.shown;
    if (phase === before) return;
    this.shown = phase;
    const { app } = this;
    document.body.classList.toggle("kiosk-attract", phase === "attract");
    this.invite.hidden = phase !== "attract";
    this.countdown.hidden = phase !== "countdown";
    // Sets how near visitors may come, too.
    if (before === "attract") app.display.views.firstPlacement();
    if (phase !== "attract") return;
    app.letGo();
    app.tools.begin("finger");
    byId("view-start").click();
    this.attractFromS = nowS() + kReturnS;
    if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
  }

  /** Takes out of the water what visitors have left in it. Repeated until the server has done so. */
  private putAway(): void {
    for (const floaterId of [...this.limits.floaterIds]) this.removeFloater(floaterId);
    if (this.ownBoatIds.length === 0 || this.nowMs - this.putAwayMs < kPutAwayEveryMs) return;
    this.putAwayMs = this.nowMs;
    for (const boatId of this.ownBoatIds) this.app.commands.send({ case: "removeBoat", value: { boatId } }, kKioskTexts.putAway);
  }

  private removeFloater(floaterId: number): void {
    this.app.commands.send({ case: "removeFloater", value: { floaterId } }, kKioskTexts.putAway);
    this.limits.removed(floaterId);
  }

  /** A new boat is seen from behind; a button leads back to the whole water. */
  private followBoat(): void {
    const { mineId } = this.app.boats;
    if (mineId !== this.boatId && mineId !== 0 && this.visit.phase !== "attract") byId("view-boat").click();
    this.boatId = mineId;
    this.view.hidden = mineId === 0;
    document.body.classList.toggle("kiosk-has-boat", this.ownBoatIds.length > 0);
    setText(this.view, document.body.classList.contains("boat-view") ? kKioskTexts.whole : kKioskTexts.boat);
  }

  private moveCamera(): void {
    const { views } = this.app.display;
    const forS = nowS() - this.attractFromS;
    if (this.shown !== "attract" || forS < 0 || !this.app.entered || window.matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    const { positionM, targetM } = views.firstPlacement();
    views.place(attractEye(positionM.toArray(), targetM.toArray(), forS), targetM.toArray());
  }
}

/** Reloads the page when it does not work any more. */
class Guard {
  private readonly storage = sessionStorageIfAny();
  private readonly watchdog = new Watchdog(Number(this.storage?.getItem(kReloadsKey)) || 0);
  private isAsking = false;
  /** Why the page has to load again, now. */
  private why: string | undefined;

  constructor(private readonly app: App | undefined) {}

  get reloads(): number {
    return this.watchdog.reloads;
  }

  pictureDrawn(): void {
    this.watchdog.pictureDrawn();
  }

  update(nowMs: number): void {
    this.why = this.watchdog.update(nowMs, { isVisible: !document.hidden, isConnected: this.app?.state.name === "live" });
    if (this.why === undefined || this.isAsking) return;
    this.isAsking = true;
    void this.reload(this.why).finally(() => (this.isAsking = false));
  }

  /** Only from a server that answers: the browser's page about one that does not is a dead end. */
  private async reload(why: string): Promise<void> {
    const isServed = await fetch(location.href, { method: "HEAD", cache: "no-store" }).then(({ ok }) => ok, () => false);
    if (!isServed) {
      console.warn(`spindrift: kiosk: ${why}; the page is not loaded again before the server answers`);
      return new Promise((done) => window.setTimeout(done, 5000));
    }
    // The connection came back meanwhile.
    if (this.why === undefined) return;
    const count = this.reloads + 1;
    console.warn(`spindrift: kiosk: ${why}; the page loads again (reload ${count} in a row)`);
    try {
      this.storage?.setItem(kReloadsKey, String(count));
    } catch {
      // Full: the next page waits no longer than this one.
    }
    location.reload();
    // The page ends soon; should it not, the next try has its time.
    return new Promise((done) => window.setTimeout(done, 5000));
  }
}
