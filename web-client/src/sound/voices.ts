// The voices as Web Audio nodes: filtered noise and oscillators, nothing from files. All nodes exist from the start and run all the time; only
// their parameters change, and never by a jump.
//   beds    noise -> band -> gain -> air -> pan -> bus
//   grains  (noise -> band -> gain, oscillator -> gain) -> air -> pan -> bus
//   bus -> water over the ears -> volume -> limiter -> output; the tone -> volume
import { makeFastRandom } from "../scene/maths/random";
import type { Grain } from "./grains";
import type { Heard } from "./hearing";
import { kBedCount, kGrainCount } from "./voice_plan";

/** Amplitude at level 1: RMS of a bed and of a grain's noise, peak of a grain's tone. */
const kBedGain = 0.35;
const kBurstGain = 0.15;
const kGrainGain = 0.5;
const kToneGain = 0.14;
/** Width of a voice's band: the noise of breaking waves falls by about 5 dB per octave (Knudsen, Alford and Emling 1948), this one by 6. */
const kBandQ = 0.6;
/** Follows changes of beds, of the volume, and of a grain that gives way. */
const kFollowS = 0.06;
const kVolumeS = 0.03;
const kGiveWayS = 0.003;
const kAttackS = 0.0012;
const kNoiseS = 4;
/** What is heard under water. */
const kUnderHz = 420;
const kOpenHz = 20_000;
/** Input of the limiter at which its output is 76 % of full scale; it never reaches 1. */
const kLimiterDrive = 0.5;
const kCurveCount = 2049;

/** Returns the gain that brings white noise of -1 to 1 in a band to an RMS of 1. */
export function bandGain(centreHz: number, rateHz: number): number {
  const widthHz = Math.min((Math.PI / 2) * (centreHz / kBandQ), rateHz / 2);
  return Math.sqrt(3) / Math.sqrt(widthHz / (rateHz / 2));
}

interface Bed {
  band: BiquadFilterNode;
  gain: GainNode;
  air: BiquadFilterNode;
  pan: StereoPannerNode;
}

interface GrainVoice extends Bed {
  oscillator: OscillatorNode;
  tone: GainNode;
}

export class Voices {
  private readonly beds: Bed[] = [];
  private readonly grains: GrainVoice[] = [];
  private readonly water: BiquadFilterNode;
  private readonly volume: GainNode;
  private readonly tone: OscillatorNode;
  private readonly toneGain: GainNode;
  private readonly analyser: AnalyserNode;
  private readonly wave = new Float32Array(2048);
  private isUnder = false;

  constructor(private readonly context: BaseAudioContext) {
    const noises = [1, 2, 3].map((seed) => this.noise(seed));
    this.volume = this.gain(0);
    this.water = this.filter("lowpass", kOpenHz);
    this.water.connect(this.volume);
    for (let n = 0; n < kBedCount; ++n) this.beds.push(this.bed(noises[n % noises.length]!));
    for (let n = 0; n < kGrainCount; ++n) {
      const bed = this.bed(noises[n % noises.length]!);
      const tone = this.gain(0);
      const oscillator = this.oscillator("sine");
      oscillator.connect(tone).connect(bed.air);
      this.grains.push({ ...bed, oscillator, tone });
    }
    this.tone = this.oscillator("triangle");
    this.toneGain = this.gain(0);
    this.tone.connect(this.toneGain).connect(this.volume);
    this.analyser = context.createAnalyser();
    this.analyser.fftSize = this.wave.length;
    this.volume.connect(this.gain(kLimiterDrive)).connect(this.limiter()).connect(this.analyser).connect(context.destination);
  }

  /** `share`: 0 to 1. */
  setVolume(share: number): void {
    this.follow(this.volume.gain, share, this.context.currentTime, kVolumeS);
  }

  setUnder(isUnder: boolean): void {
    if (isUnder === this.isUnder) return;
    this.isUnder = isUnder;
    this.follow(this.water.frequency, isUnder ? kUnderHz : kOpenHz, this.context.currentTime, kFollowS);
  }

  /** Lets a bed sound as it is heard, round `centreHz`. */
  playBed(voice: number, { level, pan, cutoffHz }: Heard, centreHz: number): void {
    const { band, gain, air, pan: panner } = this.beds[voice]!;
    const nowS = this.context.currentTime;
    this.follow(band.frequency, centreHz, nowS, kFollowS);
    this.follow(gain.gain, kBedGain * level * bandGain(centreHz, this.context.sampleRate), nowS, kFollowS);
    this.follow(air.frequency, cutoffHz, nowS, kFollowS);
    this.follow(panner.pan, pan, nowS, kFollowS);
  }

  silenceBed(voice: number): void {
    this.follow(this.beds[voice]!.gain.gain, 0, this.context.currentTime, kFollowS / 2);
  }

  /** Lets a grain begin at `startS`; what its voice played fades just before. */
  playGrain(voice: number, grain: Grain, startS: number): void {
    const { band, gain, air, pan, oscillator, tone } = this.grains[voice]!;
    if (!Number.isFinite(startS)) return;
    const fadeS = Math.max(startS, this.context.currentTime);
    const onS = fadeS + 6 * kGiveWayS;
    const { toneHz, rise, decayS, level } = grain;
    for (const param of [gain.gain, tone.gain, oscillator.frequency, band.frequency, air.frequency, pan.pan]) param.cancelScheduledValues(fadeS);
    this.follow(gain.gain, 0, fadeS, kGiveWayS);
    this.follow(tone.gain, 0, fadeS, kGiveWayS);
    this.jump(oscillator.frequency, toneHz, onS);
    this.follow(oscillator.frequency, toneHz * (1 + rise), onS, decayS);
    this.jump(band.frequency, grain.noiseHz, onS);
    this.jump(air.frequency, grain.cutoffHz, onS);
    this.jump(pan.pan, grain.pan, onS);
    this.ring(gain.gain, kBurstGain * level * grain.noiseLevel * bandGain(grain.noiseHz, this.context.sampleRate), onS, decayS);
    this.ring(tone.gain, kGrainGain * level * grain.toneLevel, onS, decayS);
  }

  /** Lets the tone reach a pitch at a time of the context. */
  playTone(hz: number, atS: number): void {
    const nowS = this.context.currentTime;
    this.follow(this.toneGain.gain, kToneGain, nowS, kVolumeS);
    if (Number.isFinite(hz) && hz > 0 && Number.isFinite(atS)) this.tone.frequency.exponentialRampToValueAtTime(hz, Math.max(atS, nowS));
  }

  silenceTone(): void {
    const nowS = this.context.currentTime;
    this.follow(this.toneGain.gain, 0, nowS, kVolumeS);
    this.tone.frequency.cancelScheduledValues(nowS);
  }

  get toneHz(): number {
    return this.tone.frequency.value;
  }

  /** Returns the RMS of the last 2048 samples of the output. */
  levelRms(): number {
    this.analyser.getFloatTimeDomainData(this.wave);
    let sum = 0;
    for (const sample of this.wave) sum += sample * sample;
    return Math.sqrt(sum / this.wave.length);
  }

  private ring(param: AudioParam, peak: number, onS: number, decayS: number): void {
    this.follow(param, peak, onS, kAttackS);
    this.follow(param, 0, onS + 4 * kAttackS, decayS);
  }

  /** Approaches a value. What is not a number would end the sound for good. */
  private follow(param: AudioParam, value: number, startS: number, withinS: number): void {
    if (Number.isFinite(value + startS + withinS)) param.setTargetAtTime(value, startS, Math.max(withinS, 1e-3));
  }

  private jump(param: AudioParam, value: number, atS: number): void {
    if (Number.isFinite(value + atS)) param.setValueAtTime(value, atS);
  }

  private bed(noise: AudioNode): Bed {
    const band = this.filter("bandpass", 500);
    band.Q.value = kBandQ;
    const gain = this.gain(0);
    const air = this.filter("lowpass", kOpenHz);
    const pan = this.context.createStereoPanner();
    noise.connect(band).connect(gain).connect(air).connect(pan).connect(this.water);
    return { band, gain, air, pan };
  }

  private gain(value: number): GainNode {
    const gain = this.context.createGain();
    gain.gain.value = value;
    return gain;
  }

  private filter(type: BiquadFilterType, hz: number): BiquadFilterNode {
    const filter = this.context.createBiquadFilter();
    filter.type = type;
    filter.frequency.value = Math.min(hz, 0.45 * this.context.sampleRate);
    return filter;
  }

  private oscillator(type: OscillatorType): OscillatorNode {
    const oscillator = this.context.createOscillator();
    oscillator.type = type;
    oscillator.start();
    return oscillator;
  }

  private noise(seed: number): AudioBufferSourceNode {
    const { context } = this;
    const buffer = context.createBuffer(1, Math.round(kNoiseS * context.sampleRate), context.sampleRate);
    const random = makeFastRandom(seed * 7919);
    const samples = buffer.getChannelData(0);
    for (let n = 0; n < samples.length; ++n) samples[n] = 2 * random() - 1;
    const source = context.createBufferSource();
    source.buffer = buffer;
    source.loop = true;
    source.start();
    return source;
  }

  private limiter(): WaveShaperNode {
    const limiter = this.context.createWaveShaper();
    const curve = new Float32Array(kCurveCount);
    for (let n = 0; n < kCurveCount; ++n) curve[n] = Math.tanh(((2 * n) / (kCurveCount - 1) - 1) / kLimiterDrive);
    limiter.curve = curve;
    return limiter;
  }
}
