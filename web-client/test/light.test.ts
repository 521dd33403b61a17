// The light of the hours and weathers, and the choice of one.
import { describe, expect, it } from "vitest";

import { Daylight, kPresetNames } from "../src/scene/light/daylight";
import { darknessOf, derive, lightAt, type Light, type Rgb } from "../src/scene/light/light";

const kStepH = 0.02;
const kHours = Array.from({ length: 24 / kStepH }, (_, i) => i * kStepH);
const kStorms = [0, 0.3, 0.65, 1];

const luminance = ([red, green, blue]: Rgb): number => 0.2126 * red + 0.7152 * green + 0.0722 * blue;

/** Numbers that decide the picture: directions count as far as light comes from them. */
function numbersOf(light: Light): number[] {
  const { keyDirection, key, sunDirection, ...rest } = light;
  const { veiled, ...derived } = derive(light);
  const flow = keyDirection.flatMap((along) => key.map((colour) => along * colour));
  return [...flow, ...sunDirection, ...Object.values(rest).flat(), ...veiled.flat(), ...Object.values(derived).flat()] as number[];
}

const lightOnWhite = ({ key, keyDirection, ambientUp, exposure }: Light): number => exposure * (1.25 * luminance(key) * keyDirection[1] + luminance(ambientUp));

describe("the light", () => {
  it("is finite, not negative, and comes from above the horizon in unit directions", () => {
    for (const storm of kStorms)
      for (const hour of kHours) {
        const light = lightAt(hour, storm);
        const { sunDirection: _, keyDirection, ...rest } = light;
        const isSound =
          numbersOf(light).every(Number.isFinite) &&
          (Object.values(rest).flat() as number[]).every((number) => number >= 0) &&
          Math.abs(Math.hypot(...keyDirection) - 1) < 1e-9 &&
          keyDirection[1] > 0 &&
          light.cloudCover <= 1;
        if (!isSound) expect.fail(`${hour} h, storm ${storm}: ${JSON.stringify(light)}`);
      }
  });

  it("changes by little within 72 s of the day, across midnight too, and with the storm", () => {
    for (const storm of kStorms)
      for (const hour of kHours) {
        const before = numbersOf(lightAt(hour, storm));
        const after = numbersOf(lightAt((hour + kStepH) % 24, storm));
        // The sun's azimuth jumps at midnight, when it is far below the horizon and nothing glows round it.
        const from = hour + kStepH >= 24 ? 12 : 0;
        for (let n = from; n < before.length; ++n)
          if (!(Math.abs(after[n]! - before[n]!) < 0.1)) expect.fail(`number ${n} at ${hour} h: ${before[n]} to ${after[n]}`);
      }
    for (const hour of [3, 7, 12, 17.2, 18.4, 23])
      for (let storm = 0; storm < 1; storm += 0.01) {
        const before = numbersOf(lightAt(hour, storm));
        numbersOf(lightAt(hour, storm + 0.01)).forEach((after, n) => {
          if (!(Math.abs(after - before[n]!) < 0.05)) expect.fail(`number ${n} at ${hour} h, storm ${storm}: ${before[n]} to ${after}`);
        });
      }
  });

  it("has no glow round the sun while its direction jumps at midnight", () => {
    expect(lightAt(0, 0).glow).toEqual([0, 0, 0]);
  });

  it("is brightest at noon, warm at the golden hour, grey in a storm", () => {
    const noon = lightAt(12, 0);
    const golden = lightAt(17.15, 0);
    const dusk = lightAt(18.35, 0);
    const moon = lightAt(23, 0);
    const storm = lightAt(12, 1);
    expect(Math.max(...kHours.map((hour) => lightOnWhite(lightAt(hour, 0))))).toBeCloseTo(lightOnWhite(noon), 9);
    expect(golden.key[0] / golden.key[2]).toBeGreaterThan(2);
    expect(golden.sunDirection[1]).toBeGreaterThan(0);
    expect(dusk.sunDirection[1]).toBeLessThan(0);
    expect(luminance(dusk.key)).toBe(0);
    expect(lightOnWhite(dusk)).toBeLessThan(0.45 * lightOnWhite(noon));
    expect(lightOnWhite(moon)).toBeLessThan(0.35 * lightOnWhite(noon));
    expect(luminance(moon.key)).toBeGreaterThan(0.05);
    const { zenith, ambientUp } = storm;
    for (const colour of [zenith, ambientUp]) expect(Math.max(...colour) / Math.min(...colour)).toBeLessThan(1.5);
    expect(lightOnWhite(storm)).toBeLessThan(0.5 * lightOnWhite(noon));
    expect(lightAt(12, 0.3)).toEqual(noon);
  });

  it("has an exposure that brightens the dark, but leaves it dark", () => {
    for (const storm of kStorms)
      for (const hour of kHours) {
        const light = lightAt(hour, storm);
        if (!(light.exposure >= 1 && light.exposure < 2.2 && lightOnWhite(light) > 0.03)) expect.fail(`${hour} h, storm ${storm}: ${JSON.stringify(light)}`);
      }
  });

  it("has stars in a fair night only", () => {
    expect(lightAt(0, 0).stars).toBe(1);
    for (const light of [lightAt(12, 0), lightAt(18.35, 0), lightAt(0, 1)]) expect(light.stars).toBe(0);
  });
});

describe("the choice of a light", () => {
  /** Returns the light some seconds after a change. */
  const settled = (daylight: Daylight): Light | undefined => {
    daylight.update(100);
    let last: Light | undefined;
    for (let s = 100.2; s < 105; s += 0.2) last = daylight.update(s) ?? last;
    return last;
  };

  it("follows the storm of the room by default, gradually, and then rests", () => {
    const daylight = new Daylight();
    daylight.setRoomStorm(0.2, true);
    expect(daylight.update(0)).toEqual(lightAt(12, 0.2));
    expect(daylight.update(1)).toBeUndefined();
    daylight.setRoomStorm(1);
    daylight.update(2);
    const half = daylight.update(2.6)!;
    expect(luminance(half.key)).toBeGreaterThan(luminance(lightAt(12, 1).key));
    expect(luminance(half.key)).toBeLessThan(luminance(lightAt(12, 0).key));
    daylight.update(5);
    expect(daylight.update(6)).toBeUndefined();
  });

  it("has the scene's hour while it is automatic, and the chosen one in every scene", () => {
    const daylight = new Daylight();
    daylight.setSceneHour(16);
    expect(daylight.hour).toBe(16);
    daylight.choose("moon");
    daylight.setSceneHour(9);
    expect(daylight.hour).toBe(23);
    daylight.chooseHour(7);
    expect(daylight.hour).toBe(7);
    daylight.choose("automatic");
    expect(daylight.hour).toBe(9);
  });

  it("shows each preset at its hour, whatever the room's storm", () => {
    for (const name of kPresetNames.filter((preset) => preset !== "automatic")) {
      const daylight = new Daylight();
      daylight.setRoomStorm(0.9, true);
      daylight.choose(name);
      expect(settled(daylight)).toEqual(lightAt(daylight.hour, name === "storm" ? 1 : 0));
    }
  });

  it("shows a chosen hour at once, in the room's weather", () => {
    const daylight = new Daylight();
    daylight.setRoomStorm(0.8, true);
    daylight.chooseHour(30);
    expect(daylight.update(0)).toEqual(lightAt(24, 0.8));
    daylight.chooseHour(7);
    expect(daylight.update(0.1)).toEqual(lightAt(7, 0.8));
  });

  it("is a fair noon while that is held, and the chosen one again afterwards", () => {
    const daylight = new Daylight();
    daylight.setRoomStorm(0.7, true);
    daylight.choose("moon");
    daylight.holdNoon(true);
    expect(settled(daylight)).toEqual(lightAt(12, 0));
    daylight.holdNoon(false);
    expect(settled(daylight)).toEqual(lightAt(23, 0));
  });
});

describe("lamps", () => {
  it("are off by day, lit at night, and come on at dusk without a jump", () => {
    expect(darknessOf(lightAt(12, 0))).toBe(0);
    expect(darknessOf(lightAt(12, 1))).toBe(0);
    expect(darknessOf(lightAt(23, 0))).toBe(1);
    let before = darknessOf(lightAt(12, 0));
    for (let hour = 12; hour <= 24; hour += 0.02) {
      const share = darknessOf(lightAt(hour, 0));
      expect(share).toBeGreaterThanOrEqual(before - 1e-9);
      expect(share - before).toBeLessThan(0.1);
      before = share;
    }
  });
});
