// Turns pointer, key, button and window events into calls of the App.
import { Vector3 } from "three";

import { pickWater } from "../scene/frames/pick";
import { byId, isTyping } from "../ui/dom";
import { TapDetector, toDeviceCoordinates, type PointerSample } from "../ui/tap";
import type { App } from "./app";

export function connectInput(app: App): void {
  connectButtons(app);
  connectPointer(app);
  connectHelmKeys(app);
  connectWindow(app);
}

function connectButtons({ client, commands, effects }: App): void {
  byId("splash").addEventListener("click", () => commands.send(effects.splashAt(0, 0), "Splash"));
  byId("wave").addEventListener("click", () => commands.send(effects.breakingWave(), "Wave"));
  byId("retry").addEventListener("click", () => client.call("retryNow"));
}

/** A click or tap splashes; a drag turns the view. */
function connectPointer(app: App): void {
  const { canvas } = app.display;
  const taps = new TapDetector();
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button === 0) taps.pressed(sampleOf(event));
  });
  canvas.addEventListener("pointercancel", (event) => taps.cancelled(event.pointerId));
  canvas.addEventListener("pointerup", (event) => {
    if (taps.released(sampleOf(event))) splashUnder(app, event);
  });
}

function sampleOf(event: PointerEvent): PointerSample {
  return { id: event.pointerId, xPx: event.clientX, yPx: event.clientY, timeMs: event.timeStamp };
}

function splashUnder({ commands, effects, display }: App, event: PointerEvent): void {
  const { canvas, scene } = display;
  const shape = scene.shape();
  if (!shape) return;
  const { camera } = scene;
  const at = toDeviceCoordinates(event.clientX, event.clientY, canvas.getBoundingClientRect());
  const direction = new Vector3(at.x, at.y, 0.5).unproject(camera).sub(camera.position).normalize();
  const place = pickWater({ originM: camera.position.toArray(), direction: direction.toArray() }, shape);
  if (place) commands.send(effects.splashAt(place.xM, place.zM), `Splash at ${place.xM.toFixed(1)}, ${place.zM.toFixed(1)} m`);
}

/** The helm's keys work in the boat's view, unless a slider, a list or a text field has the focus. */
function connectHelmKeys({ boats, display }: App): void {
  window.addEventListener("keydown", (event) => {
    if (display.views.view !== "boat" || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey || isTyping(event.target)) return;
    if (boats.key(event.code, true)) event.preventDefault();
  });
  window.addEventListener("keyup", (event) => boats.key(event.code, false));
}

function connectWindow(app: App): void {
  window.addEventListener("resize", () => app.display.resize());
  document.addEventListener("visibilitychange", () => {
    app.client.call("setVisible", !document.hidden);
    if (document.hidden) app.boats.leaveHelm();
  });
  window.addEventListener("blur", () => app.boats.leaveHelm());
  window.addEventListener("pagehide", () => app.keepIdentity(true));
  // The browser shows a page from its cache again without loading it: the resume key is in use again.
  window.addEventListener("pageshow", ({ persisted }) => persisted && app.keepIdentity(false));
}
