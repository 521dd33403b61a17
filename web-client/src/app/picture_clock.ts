// The clock by which pictures change without the water: moves of the camera, fades of the light, the sky's bakes. It is the browser's,
// unless pictures are drawn on request (stepped_pictures.ts).
let steppedS: number | undefined;

export const nowS = (): number => steppedS ?? performance.now() / 1000;

/** Stops the clock at this time. */
export function setNowS(timeS: number): void {
  steppedS = timeS;
}
