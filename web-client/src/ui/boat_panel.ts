// Boats: launch one, choose one to steer, steer it with sliders or keys, remove it.
import type { BoatDetail, GreetingInfo } from "../../client/codec/greeting";
import type { PersonInfo } from "../../client/codec/people";
import type { CommandAction } from "../../client/session/events";
import type { BodyPose } from "../../client/codec/bodies";
import type { Followed } from "../scene/camera/camera_views";
import { byId, make } from "./dom";
import { boatLimits, boatOfLength, clampTo, type BoatLimits } from "./effect_limits";
import { Helm, helmKey, type HelmKey } from "./helm";
import { kPageTime, LatestSender } from "./latest_sender";
import { SelectRow } from "./select_row";
import { SliderRow } from "./slider_row";
import { spawnPlace } from "./spawn_place";
import type { WaterPlace } from "./tools";
import { kTexts } from "./texts";

/** At most 20 helm commands per second. */
const kHelmEveryMs = 50;
/** Length of a boat whose hull is not known yet. */
const kUnknownLengthM = 2;

interface HelmOrder {
  boatId: number;
  throttleRatio: number;
  rudderRatio: number;
}

export class BoatPanel {
  /** The boat that this page steers; 0 = none. */
  mineId = 0;
  private readonly helm = new Helm();
  private readonly orders: LatestSender<HelmOrder>;
  private greeting: GreetingInfo | undefined;
  private limits: BoatLimits | undefined;
  private boats: readonly BoatDetail[] = [];
  private lengthM = 0;
  private spawnId = 0;
  private takeId = 0;
  private takeBoatId = 0;
  private isLive = false;
  private isAllowed = false;
  /** Why the lesson withholds boats. */
  private reason: string | undefined;
  private readonly reasonLine = make("p", { class: "hint", "data-testid": "no-boats", hidden: "" });
  private myPersonId = 0;
  private owners = new Map<number, number>();
  private lastS = 0;
  private readonly root = byId("boats-box");
  private readonly spawn = byId<HTMLButtonElement>("spawn");
  private readonly remove = byId<HTMLButtonElement>("remove");
  private readonly mine: SelectRow;
  private rows: { length: SliderRow; throttle: SliderRow; rudder: SliderRow } | undefined;

  constructor(
    private readonly send: (action: CommandAction, label: string) => number,
    /** The pose in which a boat is drawn now. */
    private readonly poseOf: (boatId: number) => BodyPose | undefined,
    /** Where one looks at the water; undefined if no water is seen. */
    private readonly placeSeen: () => WaterPlace | undefined,
    /** `mineId` has changed. */
    private readonly chosen: () => void,
  ) {
    this.orders = new LatestSender((order) => void send({ case: "controlBoat", value: order }, kTexts.commands.helm), kPageTime, kHelmEveryMs);
    this.mine = new SelectRow("my-boat", kTexts.boat.mine, (value) => this.request(Number(value)));
    byId("my-boat-row").append(this.reasonLine, this.mine.element);
    this.spawn.addEventListener("click", () => this.launch());
    for (const button of document.querySelectorAll<HTMLElement>("#pad [data-helm]")) {
      const key = button.dataset["helm"] as HelmKey;
      button.addEventListener("pointerdown", (event) => {
        button.setPointerCapture(event.pointerId);
        this.hold(key, true);
      });
      for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(end, () => this.hold(key, false));
      button.addEventListener("contextmenu", (event) => event.preventDefault());
    }
    this.remove.addEventListener("click", () => {
      if (this.mineId) send({ case: "removeBoat", value: { boatId: this.mineId } }, kTexts.commands.removeBoat(this.mineId));
    });
  }

  get available(): boolean {
    return this.limits !== undefined;
  }

  enter(greeting: GreetingInfo): void {
    this.greeting = greeting;
    this.limits = boatLimits(greeting);
    this.root.hidden = this.spawn.hidden = !this.limits;
    if (this.limits) this.showRows(this.limits);
    this.setBoats(this.limits ? greeting.boats : []);
    this.setLive(true);
  }

  setBoats(boats: readonly BoatDetail[]): void {
    this.boats = boats;
    if (this.mineId && !boats.some(({ boatId }) => boatId === this.mineId)) {
      this.orders.cancel();
      this.choose(0);
    }
    this.refresh();
  }

  setLive(isLive: boolean): void {
    this.isLive = isLive;
    if (!isLive) this.orders.cancel();
    this.refresh();
  }

  /** `isAllowed`: the role of this page may steer boats; `reason`: why the lesson withholds them. */
  setAllowed(isAllowed: boolean, reason: string | undefined): void {
    this.isAllowed = isAllowed;
    this.reason = reason;
    this.reasonLine.textContent = reason ?? "";
    this.reasonLine.hidden = reason === undefined;
    this.refresh();
  }

  /** The server's Welcome. `resumed`: the server knows this page from an earlier connection, and its boat is kept. */
  welcomed(personId: number, resumed: boolean): void {
    if (personId !== this.myPersonId && !resumed) this.choose(0);
    this.myPersonId = personId;
  }

  /** Updates the owners of the boats. */
  setPeople(people: readonly PersonInfo[]): void {
    this.owners = new Map(people.flatMap(({ personId, boatIds }) => boatIds.map((boatId): [number, number] => [boatId, personId])));
    const owner = this.owners.get(this.mineId);
    if (this.mineId && owner !== undefined && owner !== this.myPersonId) this.choose(0);
    const own = this.boats.find(({ boatId }) => this.owners.get(boatId) === this.myPersonId);
    if (!this.mineId && own && this.myPersonId) this.choose(own.boatId);
    this.refresh();
  }

  reject(commandId: number, _message: string, reason: string): void {
    if (commandId === this.takeId) this.takeId = 0;
    // The boat has another owner, or lost its owner while this page was disconnected.
    if (reason === "NOT_YOURS" && this.mineId && this.owners.get(this.mineId) !== this.myPersonId) this.choose(0);
    this.refresh();
  }

  ack(commandId: number, boatId: number): void {
    if (commandId === this.takeId) {
      this.takeId = 0;
      this.choose(this.takeBoatId);
      return;
    }
    if (commandId !== this.spawnId || boatId === 0) return;
    this.spawnId = 0;
    // The boat list with the new boat may arrive after the ack.
    if (!this.boats.some((boat) => boat.boatId === boatId)) this.boats = [...this.boats, { boatId, ...boatOfLength(this.lengthM) }];
    this.choose(boatId);
  }

  /** Returns true for a key of the helm; the caller then prevents the browser's own action, such as scrolling. */
  key(code: string, isDown: boolean): boolean {
    const key = helmKey(code);
    if (!key || !this.mineId) return false;
    this.hold(key, isDown);
    return true;
  }

  /** Moves throttle and rudder while their keys are held. Returns the boat that the camera follows, to be read at once. */
  update(nowS: number): Followed | undefined {
    const elapsedS = Math.min(nowS - this.lastS, 0.1);
    this.lastS = nowS;
    if (!this.mineId) return undefined;
    if (this.helm.advance(elapsedS)) {
      this.showHelm();
      this.order();
    }
    const pose = this.poseOf(this.mineId);
    if (!pose) return undefined;
    const { xM, yM, zM, headingRad } = pose;
    return { xM, yM, zM, headingRad, lengthM: this.lengthOf(this.mineId) };
  }

  /** The page lost focus: stops the engine and centres the rudder, once. */
  leaveHelm(): void {
    if (!this.mineId) return;
    const wasSet = this.helm.throttle !== 0 || this.helm.rudder !== 0;
    this.helm.centre();
    this.showHelm();
    if (!wasSet) return this.orders.cancel();
    this.order();
    this.orders.flush();
  }

  private lengthOf(boatId: number): number {
    return this.boats.find((boat) => boat.boatId === boatId)?.lengthM ?? kUnknownLengthM;
  }

  private hold(key: HelmKey, isDown: boolean): void {
    if (isDown) this.helm.press(key);
    else this.helm.release(key);
  }

  private choose(boatId: number): void {
    if (boatId === this.mineId) return this.refresh();
    this.orders.flush();
    this.mineId = boatId;
    const pose = boatId ? this.poseOf(boatId) : undefined;
    this.helm.takeOver(pose?.throttle ?? 0, pose?.rudder ?? 0);
    this.showHelm();
    this.refresh();
    this.chosen();
  }

  /** Chooses an own boat at once, and a free one after the server's ack. */
  private request(boatId: number): void {
    if (boatId === 0 || this.owners.get(boatId) === this.myPersonId) return this.choose(boatId);
    this.takeBoatId = boatId;
    this.takeId = this.send({ case: "takeBoat", value: { boatId } }, kTexts.commands.takeBoat(boatId));
  }

  private launch(): void {
    if (!this.greeting || !this.limits) return;
    const boat = boatOfLength(this.lengthM);
    const { draughtM, ...hull } = boat;
    // A course has a grid at its start.
    if (this.greeting.course) {
      this.spawnId = this.send({ case: "spawnBoat", value: { boat: hull } }, kTexts.commands.newBoat);
      return;
    }
    const others = this.boats.flatMap(({ boatId }) => this.poseOf(boatId) ?? []).map(({ xM, zM }) => ({ xM, zM }));
    const place = spawnPlace(this.greeting, boat.lengthM, draughtM, others, this.placeSeen());
    this.spawnId = this.send({ case: "spawnBoat", value: { boat: { ...hull, ...place } } }, kTexts.commands.newBoat);
  }

  private order(): void {
    if (!this.mineId || !this.isLive || this.reason !== undefined) return;
    this.orders.offer({ boatId: this.mineId, throttleRatio: this.helm.throttle, rudderRatio: this.helm.rudder });
  }

  private showHelm(): void {
    this.rows?.throttle.show(this.helm.throttle, "");
    this.rows?.rudder.show(this.helm.rudder, "");
  }

  private showRows(limits: BoatLimits): void {
    this.lengthM = clampTo(this.lengthM || limits.lengthM.default, limits.lengthM);
    if (!this.rows) {
      this.rows = {
        length: new SliderRow("boat-length", { ...limits.lengthM, ...kTexts.boat.length }, this.lengthM, (value) => (this.lengthM = value)),
        throttle: new SliderRow("throttle", { ...limits.throttleRatio, ...kTexts.boat.throttle }, 0, (value) => {
          this.helm.setThrottle(value);
          this.order();
        }),
        rudder: new SliderRow("rudder", { ...limits.rudderRatio, ...kTexts.boat.rudder }, 0, (value) => {
          this.helm.setRudder(value);
          this.order();
        }),
      };
      byId("helm").append(this.rows.throttle.element, this.rows.rudder.element, make("p", { class: "hint" }, [kTexts.boat.keys]));
      byId("new-boat").append(this.rows.length.element);
    }
    this.rows.length.setRange(limits.lengthM, this.lengthM);
    this.showHelm();
  }

  private refresh(): void {
    const open = this.boats.filter(({ boatId }) => boatId === this.mineId || [undefined, this.myPersonId].includes(this.owners.get(boatId)));
    const choices = [{ value: "0", label: open.length ? kTexts.none : kTexts.boat.noneFree }, ...open.map(({ boatId, lengthM }) => ({ value: String(boatId), label: kTexts.boat.choice(boatId, lengthM, !this.owners.has(boatId) && boatId !== this.mineId) }))];
    this.mine.setChoices(choices, String(this.mineId));
    const isOn = this.isLive && this.isAllowed && this.reason === undefined;
    const hasMine = isOn && this.mineId !== 0;
    this.mine.disabled = !isOn || open.length === 0;
    this.spawn.disabled = !isOn;
    this.remove.disabled = !hasMine;
    byId("helm").hidden = this.remove.hidden = this.mineId === 0;
    if (!this.rows) return;
    this.rows.throttle.disabled = this.rows.rudder.disabled = !hasMine;
    this.rows.length.disabled = !isOn;
  }
}
