// window.spindrift: measured values of the running page, read-only, for tests and the browser's console; and pictures on request.
import { Vector3 } from "three";

import { kLayerNames, type LayerName } from "../codec/layers";
import { elevationRangeM } from "../scene/height_field";
import { describeState } from "../ui/hud";
import type { App } from "./app";
import { SteppedPictures } from "./stepped_pictures";

/** `isStepped`: pictures are drawn on request. */
export function installTestHooks(app: App, isStepped: boolean): void {
  const hooks = {
    stats: () => stats(app),
    pixelOf: (xM: number, zM: number) => pixelOf(app, xM, zM),
    passTimesMs: (picturesCount: number) => app.display.passTimesMs(picturesCount),
    stepped: isStepped ? new SteppedPictures(app) : undefined,
  };
  Object.defineProperty(window, "spindrift", { value: Object.freeze(hooks) });
}

/** Returns where a point of the still water is on the page, in CSS pixels from the top left corner. */
function pixelOf(app: App, xM: number, zM: number): [number, number] {
  const { camera } = app.display.scene;
  const { left, top, width, height } = app.display.canvas.getBoundingClientRect();
  const { x, y } = new Vector3(xM, 0, zM).project(camera);
  return [left + ((x + 1) / 2) * width, top + ((1 - y) / 2) * height];
}

function stats(app: App) {
  const { link } = app;
  const { scene, views, framesPerS, pixelRatio, quality } = app.display;
  const surface = scene.newestSurface();
  const range = surface && elevationRangeM(surface);
  return {
    framesReceived: link?.receivedCount ?? (Object.fromEntries(kLayerNames.map((layer) => [layer, 0])) as Record<LayerName, number>),
    malformedCount: link?.malformedCount ?? 0,
    supersededCount: app.supersededCount,
    latencyMs: link?.latencyMs ?? null,
    level: link?.level ?? null,
    levelLimitedBy: link?.levelLimitedBy ?? null,
    surfaceResolutionCount: surface?.resolutionCount ?? null,
    delayMs: 1000 * (scene.clock.delayS() ?? NaN),
    simTime: app.simTimeS,
    surfaceTimeS: surface?.timeS ?? null,
    shownTimeS: scene.shownTimeS ?? null,
    lastAck: app.lastAck,
    minElevationM: range?.minM ?? null,
    maxElevationM: range?.maxM ?? null,
    connectionState: describeState(app.state),
    displayFps: framesPerS,
    pixelRatio,
    quality: quality.tier,
    paused: app.room.paused,
    boats: scene.drawnBoats(),
    whitewater: scene.whitewaterCounts(),
    role: app.role,
    myBoat: app.boats.mineId,
    view: views.view ?? null,
  };
}
