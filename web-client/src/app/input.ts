// Turns key, button and window events into calls of the App; pointers are in pointer.ts.
import { byId, isTyping } from "../ui/dom";
import type { App } from "./app";
import { connectKeyboardTools } from "./keyboard_tools";
import { connectPageKeys } from "./page_keys";
import { PointerHands } from "./pointer";
import { waterInMiddle } from "./pointer_ray";
import { GamepadTools, type GamepadTarget } from "./virtual_pointer";
import { kTexts } from "../ui/texts";

export function connectInput(app: App): void {
  const hands = new PointerHands(app);
  app.entering = () => hands.liftAll(true);
  app.lessons.watch(() => {
    if (app.lessons.whyNot(undefined) !== undefined) hands.liftAll();
  });
  connectButtons(app);
  connectHelmKeys(app);
  const { display, tools, boats } = app;
  connectKeyboardTools({ canvas: display.canvas, isHelm: () => display.views.view === "boat" && boats.mineId !== 0, isPaddle: () => tools.tool.name === "paddle" });
  connectPageKeys(app);
  const gamepad = new GamepadTools(gamepadTarget(app));
  app.poll = (atS) => gamepad.update(atS);
  connectWindow(app, hands);
}

function gamepadTarget(app: App): GamepadTarget {
  const { display, boats, tools, floaterRows, viewButtons, sound } = app;
  return {
    canvas: display.canvas,
    isHelm: () => display.views.view === "boat",
    helm: (code, isDown) => void boats.key(code, isDown),
    launch: () => byId("spawn").click(),
    stepTool: (by) => tools.step(by),
    turnHeld: (angleRad) => app.turnHeld(angleRad),
    removePointed: () => app.removePointed(),
    nextKind: () => floaterRows.step(1),
    nextView: () => viewButtons.step(),
    toggleSound: () => sound.toggle(),
    orbit: (turnRad, liftRad, zoom) => display.views.orbit(turnRad, liftRad, zoom),
  };
}

function connectButtons({ client, commands, display, effects }: App): void {
  byId("splash").addEventListener("click", () => commands.send(effects.splashAt(waterInMiddle(display) ?? { xM: 0, zM: 0 }), kTexts.commands.splash));
  byId("wave").addEventListener("click", () => commands.send(effects.breakingWave(), kTexts.commands.wave));
  byId("retry").addEventListener("click", () => client.call("retryNow"));
}

/** The helm's keys work in the boat's view, unless a slider, a list or a text field has the focus. */
function connectHelmKeys({ boats, display }: App): void {
  window.addEventListener("keydown", (event) => {
    if (display.views.view !== "boat" || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey || isTyping(event.target)) return;
    if (boats.key(event.code, true)) event.preventDefault();
  });
  window.addEventListener("keyup", (event) => boats.key(event.code, false));
}

function connectWindow(app: App, hands: PointerHands): void {
  const leave = (): void => {
    app.boats.leaveHelm();
    hands.liftAll();
  };
  app.letGo = leave;
  window.addEventListener("resize", () => app.display.resize());
  document.addEventListener("visibilitychange", () => {
    app.client.want({ visible: !document.hidden });
    if (document.hidden) leave();
  });
  window.addEventListener("blur", leave);
  window.addEventListener("pagehide", () => app.keepIdentity(true));
  // The browser shows a page from its cache again without loading it: the resume key is in use again.
  window.addEventListener("pageshow", ({ persisted }) => persisted && app.keepIdentity(false));
}
