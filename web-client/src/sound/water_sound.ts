// The sound of a room's water: looks at each frame as it comes, and gives what it says to the voices. Loaded when sound is asked for.
import type { PerspectiveCamera } from "three";

import type { GreetingInfo } from "../../client/codec/greeting";
import type { FrameLayer } from "../../client/codec/layers";
import type { FoamFrame } from "../net/messages";
import type { StreamedFrames } from "../scene/frames/streamed_frames";
import { clearanceM } from "../scene/landscape/clearance";
import { bedOf, depthAtM, insideM } from "../scene/landscape/terrain";
import { clamp } from "../scene/maths/interpolate";
import { makeFastRandom } from "../scene/maths/random";
import { AreaTiles, kTileCount } from "./area_tiles";
import { BoatWatch } from "./boat_watch";
import { addFoam, addParticles } from "./breaking_watch";
import { FloaterWatch } from "./floater_watch";
import { grainCount, grainOf, makeGrain } from "./grains";
import { hear, type Heard, type Listener } from "./hearing";
import { Heights } from "./heights";
import { SoundEvents } from "./sound_events";
import { SurfaceWatch } from "./surface_watch";
import { BedPlan, GrainPlan, kBedCount } from "./voice_plan";
import type { Voices } from "./voices";
import { kRestHz, pitchHz } from "./wave_tone";

export { Voices } from "./voices";

/** Frequencies of the beds, and of surf by its loudness. */
const kSurfHz = [280, 750] as const;
const kLapHz = 900;
const kWashHz = 600;
const kRainHz = 5500;
/** Keys of the beds: surf and lapping by tile, wash by boat, one rain of the sky and one per cloud. */
const kKeys = { surf: 0, lapping: kTileCount, rain: 2 * kTileCount, cloud: 2 * kTileCount + 1, wash: 1000 };
const kCloudsMax = 8;
/** Drops per m^2 and s that are heard as loudest, and the level of that. */
const kHeaviestRain = 0.2;
const kRainLevel = 0.5;
/** Area of a cloud's drops over its own. */
const kCloudShare = 0.15;
/** Short sounds that begin per frame. */
const kGrainsPerFrame = 10;
/** Beds are given to the voices this often; without a frame for kStaleS, as in a pause, they end. */
const kBedsEveryS = 0.05;
const kStaleS = 1;
/** A frame is shown at most this much later than it came. */
const kMostAheadS = 0.3;
const kLongestStepS = 1;
/** Water laps where its ground is within this share of the depth of the rest level. */
const kShoreDepths = 0.12;
const kSeed = 41;

/** Rain of somebody's tool. */
interface Cloud {
  xM: number;
  zM: number;
  radiusM: number;
}

/** What the wave tone reads. */
interface TonePlace {
  xM: number;
  zM: number;
  octaveM: number;
}

export class WaterSound {
  /** Somebody's rain. */
  clouds: readonly Cloud[] = [];
  /** Undefined: no tone. */
  tone: TonePlace | undefined;
  /** Elevation and pitch that the tone reached last. */
  heardTone: { elevationM: number; hz: number } | undefined;
  private readonly events = new SoundEvents();
  private readonly heights = new Heights();
  private readonly breaking = new AreaTiles();
  private surface: SurfaceWatch;
  private ground: GreetingInfo["ground"];
  private readonly boats = new BoatWatch();
  private readonly floaters = new FloaterWatch();
  private readonly beds = new BedPlan();
  private readonly grains = new GrainPlan();
  private readonly bedOffers: (Heard & { centreHz: number })[] = Array.from({ length: 48 }, () => ({ level: 0, pan: 0, cutoffHz: 1000, centreHz: 500 }));
  private readonly trial: Heard = { level: 0, pan: 0, cutoffHz: 1000 };
  private readonly grain = makeGrain();
  private readonly listener: Listener = { xM: 0, yM: 1, zM: 0, rightX: 1, rightY: 0, rightZ: 0, isUnder: false };
  private readonly random = makeFastRandom(kSeed);
  private foam: FoamFrame | undefined;
  private settledS = 0;
  /** When the water moved last, and when the beds were played last. */
  private movedAtS = -Infinity;
  private bedsAtS = -Infinity;
  /** The newest frame is shown this much later. */
  private aheadS = 0;

  /** `context`: of the voices. `greeting` is read at every frame, because its boats and its wind change. */
  constructor(
    private readonly greeting: GreetingInfo,
    private readonly voices: Voices,
    private readonly context: BaseAudioContext,
  ) {
    this.surface = new SurfaceWatch(edgesOf(greeting));
  }

  /** How many voices sound now. */
  get voiceCount(): number {
    let count = this.grains.soundingAt(this.context.currentTime);
    for (const offer of this.beds.offerOf) if (offer >= 0) ++count;
    return count;
  }

  /** Looks at the newest frame of a layer. `shownS`: time of the last picture. */
  take(layer: FrameLayer, { surfaces, foam, particles, bodies, floaters, clock }: StreamedFrames, shownS: number): void {
    const { events, breaking, greeting, heights } = this;
    const gravityMps2 = greeting.gravityMps2 || 9.81;
    events.clear();
    const frame = layer === "surface" ? surfaces.newest() : layer === "particles" ? particles.newest() : undefined;
    if (frame) this.aheadS = clamp((frame.timeS - shownS) / Math.max(clock.rate(), 0.05), 0, kMostAheadS);
    if (frame?.layer === "surface") {
      if (greeting.ground !== this.ground) this.surface = new SurfaceWatch(edgesOf(greeting));
      this.ground = greeting.ground;
      heights.take(frame);
      this.surface.take(frame, gravityMps2, events, breaking);
      this.playTone();
    } else if (frame) {
      addParticles(frame, greeting.sideM, greeting.widthM, breaking);
    } else if (layer === "foam") {
      const to = foam.newest();
      if (this.foam && to) addFoam(this.foam, to, breaking);
      this.foam = to;
    } else if (layer === "bodies") {
      this.boats.take(bodies.newest()!, greeting.boats, gravityMps2, heights.elevationAtM, events);
    } else if (layer === "floaters") {
      this.floaters.take(floaters.newest()!, gravityMps2, heights.elevationAtM, events);
    }
    this.playEvents();
    if (!frame || (frame.layer === "particles" && greeting.wave)) return;
    const stepS = frame.timeS - this.settledS;
    this.settledS = frame.timeS;
    breaking.settle(stepS > 0 && stepS < kLongestStepS ? stepS : kLongestStepS);
    if (stepS > 0) this.movedAtS = this.context.currentTime;
  }

  /** Call it after each picture. */
  update(camera: PerspectiveCamera): void {
    const nowS = this.context.currentTime;
    this.listen(camera);
    if (nowS - this.bedsAtS < kBedsEveryS) return;
    this.bedsAtS = nowS;
    // Water that stands still, as in a pause, has no note.
    if (!this.tone || nowS - this.movedAtS >= kStaleS) this.endTone();
    this.voices.setUnder(this.listener.isUnder);
    if (nowS - this.movedAtS < kStaleS) this.offerBeds();
    this.playBeds(nowS);
  }

  /** Ends all that lasts. */
  silence(): void {
    for (let voice = 0; voice < kBedCount; ++voice) this.voices.silenceBed(voice);
    this.voices.silenceTone();
  }

  private listen(camera: PerspectiveCamera): void {
    const { listener } = this;
    const { elements } = camera.matrixWorld;
    listener.xM = elements[12];
    listener.yM = elements[13];
    listener.zM = elements[14];
    listener.rightX = elements[0];
    listener.rightY = elements[1];
    listener.rightZ = elements[2];
    listener.isUnder = this.heights.isUnder(listener.xM, listener.yM, listener.zM);
  }

  private playEvents(): void {
    const nowS = this.context.currentTime;
    const { events, grain, listener, random } = this;
    let left = kGrainsPerFrame;
    for (let k = 0; k < events.count; ++k) {
      const event = events.all[k]!;
      const count = grainCount(event);
      for (let n = 0; n < count && left > 0; ++n) {
        const startS = nowS + this.aheadS + grainOf(event, n, listener, random, grain);
        const voice = this.grains.take(grain.level * Math.max(grain.toneLevel, grain.noiseLevel), startS, grain.decayS);
        if (voice < 0) continue;
        this.voices.playGrain(voice, grain, startS);
        --left;
      }
    }
  }

  private offerBeds(): void {
    const { breaking, surface: { lapping }, boats, listener, clouds } = this;
    for (let tile = 0; tile < kTileCount; ++tile) {
      const loud = Math.min(breaking.areaM2[tile]! / (0.02 * this.greeting.sideM * this.greeting.widthM), 1);
      this.offer(kKeys.surf + tile, breaking.xM[tile]!, 0, breaking.zM[tile]!, breaking.areaM2[tile]!, kSurfHz[1] + (kSurfHz[0] - kSurfHz[1]) * Math.sqrt(loud));
      this.offer(kKeys.lapping + tile, lapping.xM[tile]!, 0, lapping.zM[tile]!, lapping.areaM2[tile]!, kLapHz);
    }
    for (let n = 0; n < boats.washCount; ++n) {
      const { boatId, xM, yM, zM, areaM2 } = boats.washes[n]!;
      this.offer(kKeys.wash + boatId, xM, yM, zM, areaM2, kWashHz);
    }
    for (let n = 0; n < clouds.length && n < kCloudsMax; ++n) {
      const { xM, zM, radiusM } = clouds[n]!;
      this.offer(kKeys.cloud + n, xM, 0, zM, kCloudShare * Math.PI * radiusM * radiusM, kRainHz);
    }
    const { levelRatio = 0, dropsPerM2S = 0 } = this.greeting.wind ?? {};
    const rain = kRainLevel * Math.sqrt(clamp((levelRatio * dropsPerM2S) / kHeaviestRain, 0, 1));
    const number = this.beds.offer(kKeys.rain, rain);
    if (number >= 0) write(this.bedOffers[number]!, rain, 0, listener.isUnder ? 2000 : 16_000, kRainHz);
  }

  private offer(key: number, xM: number, yM: number, zM: number, areaM2: number, centreHz: number): void {
    const { trial } = this;
    hear(this.listener, xM, yM, zM, areaM2, trial);
    const number = this.beds.offer(key, trial.level);
    if (number >= 0) write(this.bedOffers[number]!, trial.level, trial.pan, trial.cutoffHz, centreHz);
  }

  private playBeds(nowS: number): void {
    this.beds.settle(nowS);
    for (let voice = 0; voice < kBedCount; ++voice) {
      const offer = this.beds.offerOf[voice]!;
      if (offer < 0) this.voices.silenceBed(voice);
      else this.voices.playBed(voice, this.bedOffers[offer]!, this.bedOffers[offer]!.centreHz);
    }
  }

  private endTone(): void {
    if (this.heardTone) this.voices.silenceTone();
    this.heardTone = undefined;
  }

  private playTone(): void {
    const { tone } = this;
    if (!tone) return;
    const elevationM = this.heights.elevationAtM(tone.xM, tone.zM);
    const hz = pitchHz(elevationM, tone.octaveM);
    this.heardTone ??= { elevationM: 0, hz: kRestHz };
    this.heardTone.elevationM = elevationM;
    this.heardTone.hz = hz;
    this.voices.playTone(hz, this.context.currentTime + this.aheadS);
  }
}

function write(offer: Heard & { centreHz: number }, level: number, pan: number, cutoffHz: number, centreHz: number): void {
  offer.level = level;
  offer.pan = pan;
  offer.cutoffHz = cutoffHz;
  offer.centreHz = centreHz;
}

/** Returns where water laps: at closed sides, at obstacles, and where the ground is near the rest level. */
function edgesOf(greeting: GreetingInfo): (xM: number, zM: number, cellM: number) => boolean {
  const { wave, obstacles } = greeting;
  return (xM, zM, cellM) => {
    const bed = bedOf(greeting);
    for (const side of ["+x", "-x", "+z", "-z"] as const) if (wave?.sides[side] === "closed" && insideM(side, bed, xM, zM) < cellM) return true;
    for (const obstacle of obstacles) if (Math.abs(clearanceM(obstacle, xM, zM)) < cellM) return true;
    return Math.abs(depthAtM(bed, xM, zM)) < kShoreDepths * bed.depthM;
  };
}
