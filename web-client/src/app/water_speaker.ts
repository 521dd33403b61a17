// Lets screen readers say how the water is: looks at the room from time to time and writes sentences into a live region.
import { Vector3 } from "three";

import { elevationRangeM } from "../scene/frames/height_field";
import { make, setText } from "../ui/dom";
import { describeState } from "../ui/hud";
import type { PictureSide } from "../ui/side_names";
import { WaterWords, type WaterSight } from "../ui/water_words";
import type { App } from "./app";

const kLookEveryMs = 1000;
/** Thirds of the picture. */
const kThird = 1 / 3;

export function openWaterSpeaker(app: App): void {
  const region = make("p", { class: "unseen", "data-testid": "water-words", role: "status", "aria-live": "polite" });
  document.body.append(region);
  const words = new WaterWords();
  window.setInterval(() => {
    // Nobody hears a hidden page, and before the first water there is nothing to tell.
    if (document.hidden || !app.entered) return;
    const sentence = words.take(sightOf(app), performance.now() / 1000);
    if (sentence !== undefined) setText(region, sentence);
  }, kLookEveryMs);
}

function sightOf(app: App): WaterSight {
  const { state, entered, room, display, fingers, lessons } = app;
  const surface = display.scene.newestSurface();
  const range = surface && elevationRangeM(surface);
  const hands = fingers.list.map(({ personId, xM, zM }) => ({ name: personId === lessons.ownId ? "" : (lessons.personOf(personId)?.name ?? ""), side: sideOf(app, xM, zM) }));
  return {
    trouble: state.name === "live" ? undefined : describeState(state),
    isPaused: room.paused,
    heightM: range && range.maxM - range.minM,
    sideM: Math.min(entered!.sideM, entered!.widthM),
    stormRatio: display.scene.daylight.roomStormRatio,
    hands,
  };
}

function sideOf({ display }: App, xM: number, zM: number): PictureSide {
  const { x } = new Vector3(xM, display.scene.heightAtM(xM, zM), zM).project(display.scene.camera);
  return x < -kThird ? "left" : x > kThird ? "right" : "middle";
}
