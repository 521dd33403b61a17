// Sound on this page: off until the button, the key M or a gamepad asks for it. Only then the sound's code is loaded and an AudioContext exists.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { FrameLayer } from "../../client/codec/layers";
import type { FingerInfo } from "../../client/codec/strokes";
import { StrokeTool } from "../../client/gen/spindrift/v1/wire_pb";
import { octaveForDepthM } from "../sound/wave_tone";
import type { Voices, WaterSound } from "../sound/water_sound";
import { byId, isTyping } from "../ui/dom";
import { SoundRows } from "../ui/sound_rows";
import type { Display } from "./display";
import type { Haptics } from "./haptics";
import { waterInMiddle } from "./pointer_ray";
import { kTexts } from "../ui/texts";

/** The middle of the view is looked for this often. */
const kMiddleEveryMs = 250;
/** The sound has faded when its context stops. */
const kFadedMs = 200;

export class SoundControls {
  isOn = false;
  private readonly button = byId<HTMLButtonElement>("sound-toggle");
  private readonly rows: SoundRows;
  private context: AudioContext | undefined;
  private voices: Voices | undefined;
  private sound: WaterSound | undefined;
  private makeSound: ((greeting: GreetingInfo) => WaterSound) | undefined;
  private greeting: GreetingInfo | undefined;
  private clouds: FingerInfo[] = [];
  private middleMs = 0;
  private readonly tone = { xM: 0, zM: 0, octaveM: 1 };
  private isToneKnown = false;

  /** `failed`: the code of the sound could not be loaded. */
  constructor(
    private readonly display: Display,
    haptics: Haptics,
    private readonly failed: (why: string) => void,
  ) {
    this.rows = new SoundRows(() => this.changed(), haptics);
    this.button.addEventListener("click", () => this.toggle());
    window.addEventListener("keydown", (event) => {
      if (event.key.toLowerCase() === "m" && !event.repeat && !event.ctrlKey && !event.altKey && !event.metaKey && !isTyping(event.target)) this.toggle();
    });
    document.addEventListener("visibilitychange", () => this.run());
    // Browsers let a page sound only after a press.
    for (const press of ["pointerdown", "keydown"]) window.addEventListener(press, () => this.isOn && this.context?.state === "suspended" && this.run());
  }

  toggle(): void {
    this.isOn = !this.isOn;
    this.button.setAttribute("aria-pressed", String(this.isOn));
    if (this.isOn) {
      this.context ??= new AudioContext();
      this.context.onstatechange ??= () => this.showWaiting();
      void this.load();
    } else {
      this.sound?.silence();
    }
    this.changed();
    this.run();
  }

  enter(greeting: GreetingInfo): void {
    this.greeting = greeting;
    this.sound?.silence();
    this.sound = this.makeSound?.(greeting);
    this.clouds = [];
    this.rows.enter(greeting.wave && greeting.gauges.map(({ name }) => name), octaveForDepthM(greeting.waterExtents.depthM));
    this.changed();
  }

  setFingers(fingers: readonly FingerInfo[]): void {
    this.clouds = fingers.filter(({ tool }) => tool === StrokeTool.RAIN);
  }

  /** Call it for each frame that the scene has taken. */
  take(layer: FrameLayer): void {
    const { scene } = this.display;
    const sound = this.audible;
    if (!sound || scene.shownTimeS === undefined) return;
    sound.take(layer, scene.frames, scene.shownTimeS);
  }

  /** Call it after each picture. */
  update(): void {
    const sound = this.audible;
    if (!sound) return;
    this.findTone(performance.now());
    sound.clouds = this.clouds;
    sound.tone = this.isToneKnown ? this.tone : undefined;
    sound.update(this.display.scene.camera);
  }

  /** For tests: what sounds now; undefined before sound was asked for. */
  stats() {
    const { context, voices, sound } = this;
    if (!context) return undefined;
    return {
      isOn: this.isOn,
      state: context.state,
      levelRms: voices?.levelRms() ?? 0,
      voiceCount: sound?.voiceCount ?? 0,
      tone: sound?.heardTone && { ...sound.heardTone, playsHz: voices!.toneHz },
    };
  }

  private get audible(): WaterSound | undefined {
    return this.isOn && this.context?.state === "running" ? this.sound : undefined;
  }

  private async load(): Promise<void> {
    try {
      const { Voices, WaterSound } = await import("../sound/water_sound");
      const context = this.context!;
      const voices = (this.voices ??= new Voices(context));
      this.makeSound ??= (greeting) => new WaterSound(greeting, voices, context);
      if (this.greeting) this.sound ??= this.makeSound(this.greeting);
      this.changed();
    } catch (error) {
      if (this.isOn) this.toggle();
      this.failed(kTexts.soundFailed(error instanceof Error ? error.message : String(error)));
    }
  }

  /** Volume or tone. */
  private changed(): void {
    this.voices?.setVolume(this.isOn ? this.rows.volume : 0);
    this.tone.octaveM = this.rows.octaveM;
    this.middleMs = 0;
  }

  /** Runs the context while there is somebody to hear it. */
  private run(): void {
    const { context } = this;
    if (!context) return;
    if (this.isOn && !document.hidden) void context.resume();
    else window.setTimeout(() => (!this.isOn || document.hidden) && void context.suspend(), document.hidden ? 0 : kFadedMs);
    this.showWaiting();
  }

  private showWaiting(): void {
    this.rows.setWaiting(this.isOn && this.context?.state !== "running");
  }

  private findTone(nowMs: number): void {
    const { rows } = this;
    if (!rows.tone) {
      this.isToneKnown = false;
    } else if (rows.tone.gauge === undefined) {
      if (nowMs >= this.middleMs) this.findMiddle(nowMs);
    } else {
      for (const { name, xM, zM } of this.greeting!.gauges) if (name === rows.tone.gauge) this.place(xM, zM);
    }
  }

  private findMiddle(nowMs: number): void {
    this.middleMs = nowMs + kMiddleEveryMs;
    const at = waterInMiddle(this.display);
    if (at) this.place(at.xM, at.zM);
  }

  private place(xM: number, zM: number): void {
    this.tone.xM = xM;
    this.tone.zM = zM;
    this.isToneKnown = true;
  }
}
