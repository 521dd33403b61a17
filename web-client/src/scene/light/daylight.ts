// Which light is shown: the hour and the weather that the user chose, or the room's storm. Changes are gradual. Pure: no renderer.
import { clamp, mix, smooth } from "../maths/interpolate";
import { lightAt, type Light } from "./light";

/** Points of the day by name. `hour` undefined: the scene's, `storm` undefined: the room's. */
const kPresets = {
  automatic: { hour: undefined, storm: undefined },
  noon: { hour: 12, storm: 0 },
  "golden hour": { hour: 17.15, storm: 0 },
  dusk: { hour: 18.35, storm: 0 },
  moon: { hour: 23, storm: 0 },
  storm: { hour: 12, storm: 1 },
} as const;

export type PresetName = keyof typeof kPresets;
export const kPresetNames = Object.keys(kPresets) as readonly PresetName[];

/** A change takes about this long. */
const kTravelS = 1.2;

interface Moment {
  hour: number;
  storm: number;
}

export class Daylight {
  private chosen: { hour: number | undefined; storm: number | undefined } = kPresets.automatic;
  private sceneHour = 12;
  private roomStorm = 0;
  private isNoonHeld = false;
  private shown: Moment = { hour: 12, storm: 0 };
  /** `shown` has not been returned yet. */
  private isNew = true;
  private travel: { from: Moment; to: Moment; beganS: number } | undefined;

  /** The chosen hour of the day, for an automatic one the scene's. */
  get hour(): number {
    return this.chosen.hour ?? this.sceneHour;
  }

  choose(name: PresetName): void {
    this.chosen = kPresets[name];
  }

  /** Chooses an hour (0..24) in the weather of the room, without a transition: a slider is one. */
  chooseHour(hour: number): void {
    this.chosen = { hour: clamp(hour, 0, 24), storm: undefined };
    this.shown = this.target();
    this.travel = undefined;
    this.isNew = true;
  }

  /** Takes the hour in which the scene is seen first; setRoomStorm() shows it. */
  setSceneHour(hour: number): void {
    this.sceneHour = hour;
  }

  /** The storm of the room, 0..1, whatever light the user chose. */
  get roomStormRatio(): number {
    return this.roomStorm;
  }

  /** Follows the storm of the room, 0..1. `atOnce`: the room is new. */
  setRoomStorm(storm: number, atOnce = false): void {
    this.roomStorm = clamp(storm, 0, 1);
    if (!atOnce) return;
    this.shown = this.target();
    this.travel = undefined;
    this.isNew = true;
  }

  /** While `isHeld`, the light is that of a fair noon, whatever was chosen: for looks whose colours are data. */
  holdNoon(isHeld: boolean): void {
    this.isNoonHeld = isHeld;
  }

  /** Returns the light to show, or undefined if it is that of the call before. */
  update(nowS: number): Light | undefined {
    const to = this.target();
    const towards = this.travel?.to ?? this.shown;
    if (to.hour !== towards.hour || to.storm !== towards.storm) this.travel = { from: { ...this.shown }, to, beganS: nowS };
    if (!this.travel && !this.isNew) return undefined;
    this.isNew = false;
    if (!this.travel) return lightAt(this.shown.hour, this.shown.storm);
    const share = Math.min((nowS - this.travel.beganS) / kTravelS, 1);
    const eased = smooth(share);
    const { from } = this.travel;
    this.shown = share < 1 ? { hour: mix(from.hour, to.hour, eased), storm: mix(from.storm, to.storm, eased) } : to;
    if (share >= 1) this.travel = undefined;
    return lightAt(this.shown.hour, this.shown.storm);
  }

  private target(): Moment {
    if (this.isNoonHeld) return kPresets.noon;
    return { hour: this.hour, storm: this.chosen.storm ?? this.roomStorm };
  }
}
