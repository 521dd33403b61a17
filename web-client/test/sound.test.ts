// What is heard of the water: from frames to events, areas, voices and the parameters of Web Audio's nodes.
import { describe, expect, it } from "vitest";

import type { GreetingInfo } from "../client/codec/greeting";
import type { FoamFrame, SurfaceFrame } from "../src/net/messages";
import { makePose } from "../src/scene/frames/bodies";
import { StreamedFrames } from "../src/scene/frames/streamed_frames";
import { makeFastRandom } from "../src/scene/maths/random";
import { AreaTiles } from "../src/sound/area_tiles";
import { BoatWatch } from "../src/sound/boat_watch";
import { addFoam } from "../src/sound/breaking_watch";
import { bubbleRadiusM, dampingPerS, minnaertHz } from "../src/sound/bubbles";
import { FloaterWatch } from "../src/sound/floater_watch";
import { grainCount, grainOf, makeGrain } from "../src/sound/grains";
import { hear, type Heard, type Listener } from "../src/sound/hearing";
import { SoundEvents } from "../src/sound/sound_events";
import { SurfaceWatch } from "../src/sound/surface_watch";
import { BedPlan, GrainPlan, kBedCount, kFadeS, kGrainCount } from "../src/sound/voice_plan";
import { bandGain, Voices } from "../src/sound/voices";
import { WaterSound } from "../src/sound/water_sound";
import { kRestHz, octaveForDepthM, pitchHz } from "../src/sound/wave_tone";
import { kTexts } from "../src/ui/texts";
import { FakeAudio } from "./fake_audio";

const kSideM = 16;
const kCount = 64;
const kStepS = 1 / 30;
const kGravity = 9.81;
const header = { tick: 0n, stateId: 0n, serverTimeS: 0, level: "full" as const };

function surfaceFrame(timeS: number, elevationM: (xM: number, zM: number) => number): SurfaceFrame {
  const samples = new Int16Array(kCount * kCount);
  const at = (i: number): number => ((i + 0.5) / kCount - 0.5) * kSideM;
  samples.forEach((_, n) => (samples[n] = Math.round(elevationM(at(n % kCount), at(Math.floor(n / kCount))) * 1000)));
  return { ...header, layer: "surface", timeS, resolutionCount: kCount, countZ: kCount, sideM: kSideM, widthM: kSideM, quantumM: 0.001, buffer: samples.buffer };
}

function foamFrame(timeS: number, value: (xM: number) => number): FoamFrame {
  const bytes = new Uint8Array(kCount * kCount);
  bytes.forEach((_, n) => (bytes[n] = value((((n % kCount) + 0.5) / kCount - 0.5) * kSideM)));
  return { ...header, layer: "foam", timeS, resolutionCount: kCount, countZ: kCount, sideM: kSideM, widthM: kSideM, buffer: bytes.buffer };
}

const listener = (change: Partial<Listener> = {}): Listener => ({ xM: 0, yM: 5, zM: 20, rightX: 1, rightY: 0, rightZ: 0, isUnder: false, ...change });
const heardOf = (from: Listener, xM: number, zM: number, areaM2: number): Heard => {
  const heard = { level: NaN, pan: NaN, cutoffHz: NaN };
  hear(from, xM, 0, zM, areaM2, heard);
  return heard;
};

/** Lets a surface move for some frames; returns what was heard. */
function watch(framesCount: number, elevationM: (timeS: number, xM: number, zM: number) => number, isEdgeAt = (_x: number, _z: number): boolean => false) {
  const surface = new SurfaceWatch(isEdgeAt);
  const breaking = new AreaTiles();
  const splashes: { xM: number; zM: number; areaM2: number; radiusM: number }[] = [];
  for (let k = 0; k < framesCount; ++k) {
    const events = new SoundEvents();
    surface.take(surfaceFrame(k * kStepS, (xM, zM) => elevationM(k * kStepS, xM, zM)), kGravity, events, breaking);
    breaking.settle(kStepS);
    splashes.push(...events.all.slice(0, events.count).map(({ xM, zM, areaM2, radiusM }) => ({ xM, zM, areaM2, radiusM })));
  }
  return { splashes, breakingM2: Math.max(...breaking.areaM2), lappingM2: Math.max(...surface.lapping.areaM2) };
}

/** A dent of 30 cm that is pressed within 0.2 s from 0.5 s on. */
const dent = (radiusM: number) => (timeS: number, xM: number, zM: number): number => {
  const share = Math.min(Math.max((timeS - 0.5) / 0.2, 0), 1);
  return -0.3 * share * share * (3 - 2 * share) * Math.exp(-((xM - 3) ** 2 + (zM + 2) ** 2) / radiusM ** 2);
};

describe("the surface", () => {
  it("is silent while it is calm, and while it only rounds", () => {
    const random = makeFastRandom(3);
    for (const elevationM of [() => 0, () => 0.001 * Math.round(random() - 0.5)]) {
      const { splashes, breakingM2, lappingM2 } = watch(60, elevationM, () => true);
      expect(splashes).toEqual([]);
      expect(breakingM2).toBe(0);
      expect(lappingM2).toBeLessThan(0.2);
    }
  });

  it("is silent under a swell that does not break", () => {
    const { splashes } = watch(90, (timeS, xM) => 0.4 * Math.sin(2 * timeS - 0.4 * xM));
    expect(splashes).toEqual([]);
  });

  it("tells where a splash is, and how large", () => {
    const small = watch(30, dent(0.5)).splashes;
    const large = watch(30, dent(1.5)).splashes;
    const largestOf = (splashes: typeof small) => splashes.reduce((best, each) => (each.areaM2 > best.areaM2 ? each : best));
    for (const splashes of [small, large]) {
      expect(splashes.length).toBeGreaterThan(0);
      expect(splashes.length).toBeLessThan(30);
      expect(Math.hypot(largestOf(splashes).xM - 3, largestOf(splashes).zM + 2)).toBeLessThan(2);
    }
    expect(largestOf(large).areaM2).toBeGreaterThan(2 * largestOf(small).areaM2);
  });

  it("laps at edges only", () => {
    const seiche = (timeS: number, xM: number): number => 0.05 * Math.cos(3 * timeS) * Math.sin((Math.PI * xM) / kSideM);
    expect(watch(60, seiche, (xM) => Math.abs(xM) > 7.5).lappingM2).toBeGreaterThan(0.02);
    expect(watch(60, seiche).lappingM2).toBe(0);
  });

  it("begins anew after a gap, a reset, and at another level of detail", () => {
    const surface = new SurfaceWatch(() => true);
    const breaking = new AreaTiles();
    const events = new SoundEvents();
    for (const [timeS, heightM] of [[5, 0], [5.03, 0], [9, 1], [9.03, 1], [0, -1], [0, -1], [0.03, -1]] as const) surface.take(surfaceFrame(timeS, () => heightM), kGravity, events, breaking);
    expect(events.count).toBe(0);
    expect([...surface.lapping.areaM2].every(Number.isFinite)).toBe(true);
  });
});

describe("breaking water", () => {
  const breakers = (): AreaTiles => {
    const breaking = new AreaTiles();
    for (let k = 1; k < 10; ++k) {
      addFoam(foamFrame((k - 1) * kStepS, (xM) => (xM > 4 + 0.25 * k ? 255 : 0)), foamFrame(k * kStepS, (xM) => (xM > 3.75 + 0.25 * k - 0.5 ? 255 : 0)), breaking);
      breaking.settle(kStepS);
    }
    return breaking;
  };

  it("is louder near than far, on its side, and duller far", () => {
    const { areaM2, xM, zM } = breakers();
    const tile = areaM2.indexOf(Math.max(...areaM2));
    const near = heardOf(listener({ zM: 10 }), xM[tile]!, zM[tile]!, areaM2[tile]!);
    const far = heardOf(listener({ zM: 200 }), xM[tile]!, zM[tile]!, areaM2[tile]!);
    expect(near.level).toBeGreaterThan(2 * far.level);
    expect(far.level).toBeGreaterThan(0.01);
    expect(near.cutoffHz).toBeGreaterThan(2 * far.cutoffHz);
    expect(near.pan).toBeGreaterThan(0.2);
    expect(heardOf(listener({ rightX: -1, zM: 10 }), xM[tile]!, zM[tile]!, areaM2[tile]!).pan).toBeLessThan(-0.2);
  });

  it("is what grows, not what is white", () => {
    const breaking = new AreaTiles();
    addFoam(foamFrame(0, () => 255), foamFrame(kStepS, () => 255), breaking);
    addFoam(foamFrame(0, () => 255), foamFrame(kStepS, () => 0), breaking);
    addFoam(foamFrame(0, () => 0), foamFrame(0, () => 255), breaking);
    breaking.settle(kStepS);
    expect(Math.max(...breaking.areaM2)).toBe(0);
    expect(Math.max(...breakers().areaM2)).toBeGreaterThan(1);
  });

  it("sounds as loud in a tank as at sea, if it is as large on the picture", () => {
    expect(heardOf(listener({ yM: 0, zM: 10 }), 0, 0, 0.01).level).toBeCloseTo(heardOf(listener({ yM: 0, zM: 1000 }), 0, 0, 100).level, 6);
  });
});

describe("bubbles", () => {
  it("ring as Minnaert says: 3.26 kHz at 1 mm", () => {
    expect(minnaertHz(0.001)).toBeCloseTo(3260, 6);
    expect(dampingPerS(0.001)).toBeGreaterThan(dampingPerS(0.01));
  });

  it("ring higher under a drop of 1 cm than under one of 10 cm", () => {
    const of = (radiusM: number) => {
      const grain = makeGrain();
      grainOf({ kind: "plunge", xM: 0, yM: 0, zM: 0, areaM2: radiusM ** 2, radiusM, boatId: 0 }, 1, listener(), () => 0.5, grain);
      return grain;
    };
    expect(of(0.005).toneHz).toBeGreaterThan(5 * of(0.05).toneHz);
    expect(of(0.005).decayS).toBeLessThan(of(0.05).decayS);
    expect(minnaertHz(bubbleRadiusM(100))).toBeGreaterThan(20);
  });
});

describe("boats and objects", () => {
  const boat = { boatId: 7, lengthM: 4, beamM: 1.5, heightM: 1, draughtM: 0.4 };
  const sail = (poses: Partial<ReturnType<typeof makePose>>[]) => {
    const boats = new BoatWatch();
    const heard: string[] = [];
    poses.forEach((pose, k) => {
      const events = new SoundEvents();
      boats.take({ timeS: k * kStepS, stateId: 0n, bodies: [{ ...makePose(), boatId: 7, ...pose }] }, [boat], kGravity, () => 0, events);
      heard.push(...events.all.slice(0, events.count).map(({ kind, boatId }) => `${kind} ${boatId}`));
    });
    return { heard, washM2: boats.washCount > 0 ? boats.washes[0]!.areaM2 : 0 };
  };

  it("slap when the bow falls on the water, once per fall", () => {
    expect(sail(Array.from({ length: 20 }, (_, k) => ({ pitchRad: 0.02 * Math.sin(0.2 * k) }))).heard).toEqual([]);
    expect(sail(Array.from({ length: 20 }, (_, k) => ({ yM: k < 10 ? 0.5 : Math.max(0.5 - 0.06 * (k - 9) ** 2, 0) }))).heard).toEqual(["slap 7"]);
  });

  it("knock when they are stopped at once, and wash as fast as they are", () => {
    expect(sail(Array.from({ length: 10 }, (_, k) => ({ speedMps: k < 5 ? 3 : 0 }))).heard).toEqual(["knock 7"]);
    expect(sail([{ speedMps: 0.2 }, { speedMps: 0.2 }]).washM2).toBe(0);
    expect(sail([{ speedMps: 4 }, { speedMps: 4 }]).washM2).toBeGreaterThan(sail([{ speedMps: 2 }, { speedMps: 2 }]).washM2);
  });

  it("plunge where they fall in, and are silent while they float", () => {
    const floaters = new FloaterWatch();
    const events = new SoundEvents();
    for (let k = 0; k < 30; ++k) {
      const falls = Math.max(1 - 4.9 * (k * kStepS) ** 2, -0.1);
      const of = (floaterId: number, yM: number) => ({ floaterId, kind: "ball" as const, xM: 1, yM, zM: 2, turn: [0, 0, 0, 1] as [number, number, number, number], sizeM: 0.4, isHeld: false });
      floaters.take({ timeS: k * kStepS, stateId: 0n, floaters: [of(1, falls), of(2, 0.02 * Math.sin(k))] }, kGravity, () => 0, events);
    }
    expect(events.count).toBe(1);
    expect(events.all[0]).toMatchObject({ kind: "plunge", xM: 1, zM: 2, radiusM: 0.2 });
  });
});

describe("a storm of 1,000 events", () => {
  it("leaves the largest in a list that does not grow", () => {
    const events = new SoundEvents();
    for (let k = 1; k <= 1000; ++k) events.add("splash", 0, 0, 0, k, 0.1);
    const areas = events.all.slice(0, events.count).map(({ areaM2 }) => areaM2);
    expect(areas.length).toBe(events.all.length);
    expect(Math.min(...areas)).toBe(1001 - areas.length);
  });

  it("takes at most the voices that there are, the loudest", () => {
    const random = makeFastRandom(5);
    const grains = new GrainPlan();
    const beds = new BedPlan();
    let changes = 0;
    for (let k = 0; k < 1000; ++k) {
      grains.take(random(), k / 1000, 0.1);
      expect(grains.soundingAt(k / 1000)).toBeLessThanOrEqual(kGrainCount);
      for (let key = 0; key < 60; ++key) beds.offer(key, key / 60);
      const before = beds.offerOf.join();
      beds.settle(k / 100);
      if (beds.offerOf.join() !== before) ++changes;
    }
    expect([...beds.offerOf].filter((offer) => offer >= 0)).toHaveLength(kBedCount);
    expect(changes).toBeLessThanOrEqual(2);
    expect(kBedCount + kGrainCount).toBe(12);
    expect(grains.take(0.001, 1, 0.1)).toBe(-1);
    expect(grains.take(1, 1, 0.1)).toBeGreaterThanOrEqual(0);
  });

  it("lets a bed fade before its voice has another", () => {
    const beds = new BedPlan();
    const settle = (level: number, other: number, nowS: number): number[] => {
      for (let key = 0; key < kBedCount; ++key) beds.offer(key, level);
      if (other > 0) beds.offer(99, other);
      beds.settle(nowS);
      return [...beds.offerOf];
    };
    settle(0.5, 0, 0);
    expect(settle(0.5, 0, kFadeS)).not.toContain(-1);
    expect(settle(0.5, 0.6, 2 * kFadeS)).not.toContain(kBedCount);
    expect(settle(0.5, 0.9, 3 * kFadeS).filter((offer) => offer === -1)).toHaveLength(1);
    expect(settle(0.5, 0.9, 3.5 * kFadeS)).toContain(-1);
    expect(settle(0.5, 0.9, 4 * kFadeS)).toContain(kBedCount);
  });
});

describe("the voices", () => {
  it("set every parameter to finite values, whatever the frames say", () => {
    const audio = new FakeAudio();
    const voices = new Voices(audio.context);
    const greeting = { sideM: kSideM, widthM: kSideM, waterExtents: { sideM: kSideM, longM: kSideM, depthM: 2 }, beaches: [], obstacles: [], boats: [], gravityMps2: kGravity, setting: "openSea", wave: { sides: { "+x": "closed", "-x": "closed", "+z": "closed", "-z": "closed" }, depthM: 2 } } as unknown as GreetingInfo;
    const sound = new WaterSound(greeting, voices, audio.context);
    sound.tone = { xM: 1, zM: 1, octaveM: 0.2 };
    const frames = new StreamedFrames(() => {});
    frames.enter(true, false);
    const random = makeFastRandom(9);
    let most = 0;
    for (let k = 0; k < 200; ++k) {
      audio.nowS = k * kStepS;
      // Every sample jumps; time stands still, and goes back.
      const timeS = k === 100 ? 0 : k * kStepS - (k % 50 === 7 ? kStepS : 0);
      frames.take(surfaceFrame(timeS, () => 30 * (random() - 0.5)), k * kStepS);
      sound.take("surface", frames, timeS);
      frames.take(foamFrame(timeS, () => 255 * random()), k * kStepS);
      sound.take("foam", frames, timeS);
      sound.update({ matrixWorld: { elements: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, k === 5 ? 0 : 3, k === 5 ? 0 : 12, 1] } } as never);
      most = Math.max(most, sound.voiceCount);
    }
    for (const value of [NaN, Infinity, -Infinity]) {
      voices.setVolume(value);
      voices.playTone(value, 0);
      voices.playBed(0, { level: value, pan: value, cutoffHz: value }, value);
      voices.playGrain(0, { ...makeGrain(), level: value, toneHz: value, decayS: value }, value);
    }
    expect(most).toBeGreaterThan(6);
    expect(most).toBeLessThanOrEqual(kBedCount + kGrainCount);
    expect(audio.values.length).toBeGreaterThan(1000);
    expect(audio.values.every(Number.isFinite)).toBe(true);
    expect(audio.nodeCount).toBe(audio.firstNodeCount);
  });

  it("have one loudness in narrow and wide bands", () => {
    expect(bandGain(200, 48_000)).toBeGreaterThan(4 * bandGain(5000, 48_000));
    expect(bandGain(1e6, 48_000)).toBeCloseTo(Math.sqrt(3), 6);
  });

  it("begin no more grains than events give", () => {
    expect(grainCount({ kind: "slap", xM: 0, yM: 0, zM: 0, areaM2: 1, radiusM: 1, boatId: 1 })).toBe(1);
  });
});

describe("the wave tone", () => {
  it("is an octave per chosen height, and two octaves wide", () => {
    expect(pitchHz(0, 0.2)).toBe(kRestHz);
    expect(pitchHz(0.2, 0.2)).toBeCloseTo(2 * kRestHz, 9);
    expect(pitchHz(-0.1, 0.2)).toBeCloseTo(kRestHz / Math.SQRT2, 9);
    expect(pitchHz(5, 0.2)).toBeCloseTo(2 * kRestHz, 9);
  });

  it("suits the depth, and says what it maps", () => {
    expect(octaveForDepthM(1.5)).toBe(0.2);
    expect(octaveForDepthM(0.01)).toBe(0.01);
    expect(kTexts.octave(0.2)).toBe("±20 cm = ±1 octave");
    expect(kTexts.octave(2)).toBe("±2 m = ±1 octave");
  });
});
