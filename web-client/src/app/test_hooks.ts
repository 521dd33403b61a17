// window.spindrift: measured values of the running page, read-only, for tests and the browser's console; and pictures on request.
import { Vector3 } from "three";

import { kLayerNames, type LayerName } from "../../client/codec/layers";
import { elevationRangeM } from "../scene/frames/height_field";
import { describeState } from "../ui/hud";
import type { App } from "./app";
import { SteppedPictures } from "./stepped_pictures";

/** `isStepped`: pictures are drawn on request. */
export function installTestHooks(app: App, isStepped: boolean): void {
  const hooks = {
    stats: () => stats(app),
    pixelOf: (xM: number, zM: number, yM = 0) => pixelOf(app, [xM, yM, zM]),
    shoreAt: (xM: number, zM: number) => app.display.scene.shoreAt(xM, zM) ?? null,
    passTimesMs: (picturesCount: number) => app.display.passTimesMs(picturesCount),
    stepped: isStepped ? new SteppedPictures(app) : undefined,
  };
  Object.defineProperty(window, "spindrift", { value: Object.freeze(hooks) });
}

/** Returns where a point is on the page, in CSS pixels from the top left corner; the still water is at y = 0. */
function pixelOf(app: App, atM: [x: number, y: number, z: number]): [number, number] {
  const { camera } = app.display.scene;
  const { left, top, width, height } = app.display.canvas.getBoundingClientRect();
  const { x, y } = new Vector3(...atM).project(camera);
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
    lastCommand: app.commands.last ?? null,
    minElevationM: range?.minM ?? null,
    maxElevationM: range?.maxM ?? null,
    connectionState: describeState(app.state),
    displayFps: framesPerS,
    pixelRatio,
    quality: quality.tier,
    paused: app.room.paused,
    boats: scene.drawnBoats(),
    floaters: scene.drawnFloaters().map((pose) => ({ ...pose, turn: [...pose.turn] })),
    dents: scene.ripple.count.value,
    gauges: scene.drawnGauges(),
    whitewater: scene.whitewaterCounts(),
    role: app.role,
    myBoat: app.boats.mineId,
    view: views.view ?? null,
    sound: app.sound.stats() ?? null,
  };
}
