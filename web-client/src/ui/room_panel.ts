// Controls that affect everybody in the room: pause, single steps, reset, speed, scene, fidelity.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { DiagnosticsInfo } from "../../client/codec/parse";
import type { CommandAction } from "../../client/session/events";
import { byId, make, setText } from "./dom";
import { speedRange } from "./effect_limits";
import { FidelityRow } from "./fidelity_row";
import { kPageTime } from "./latest_sender";
import { SelectRow } from "./select_row";
import { SliderModel } from "./slider_model";
import { SliderRow } from "./slider_row";
import { kTexts } from "./texts";

export class RoomPanel {
  paused = false;
  private isLive = false;
  private isAllowed = false;
  private sceneName = "";
  private changeId = 0;
  private readonly pause = byId<HTMLButtonElement>("pause");
  private readonly step = byId<HTMLButtonElement>("step");
  private readonly reset = byId<HTMLButtonElement>("reset");
  private readonly speedRow: SliderRow;
  private readonly speed: SliderModel;
  private readonly scenes: SelectRow;
  /** While the server builds another scene. */
  private readonly opening = make("p", { class: "hint", "data-testid": "opening", hidden: "" });
  private readonly fidelity: FidelityRow;

  constructor(send: (action: CommandAction, label: string) => number) {
    this.pause.addEventListener("click", () => {
      send({ case: "setPaused", value: { paused: !this.paused } }, this.paused ? kTexts.commands.resume : kTexts.commands.pause);
    });
    this.step.addEventListener("click", () => send({ case: "step", value: { tickCount: 1 } }, kTexts.commands.step));
    this.reset.addEventListener("click", () => send({ case: "reset", value: {} }, kTexts.commands.reset));
    this.speedRow = new SliderRow("speed", { ...speedRange(), ...kTexts.speed }, 1, (value) => this.speed.input(value));
    this.speed = new SliderModel(1, {
      send: (value) => send({ case: "setSpeed", value: { speed: value } }, kTexts.commands.speed),
      ...kPageTime,
      changed: () => this.speedRow.show(this.speed.shownValue, this.speed.error),
    });
    this.scenes = new SelectRow("scene", kTexts.scene, (name) => {
      this.changeId = send({ case: "changeScene", value: { name } }, kTexts.commands.scene(sceneLabel(name)));
      setText(this.opening, kTexts.building(sceneLabel(name)));
      this.opening.hidden = false;
    });
    this.fidelity = new FidelityRow(send);
    byId("room").append(this.scenes.element, this.opening, this.fidelity.pace);
    byId("speed-row").append(this.speedRow.element);
    byId("fidelity-row").append(this.fidelity.element);
  }

  enter(greeting: GreetingInfo): void {
    this.sceneName = greeting.sceneName;
    const names = greeting.scenes.includes(greeting.sceneName) || greeting.scenes.length === 0 ? greeting.scenes : [greeting.sceneName, ...greeting.scenes];
    this.scenes.setChoices(names.map((name) => ({ value: name, label: sceneLabel(name) })), this.sceneName);
    this.scenes.element.hidden = names.length < 2;
    this.fidelity.enter(greeting);
    this.roomState(greeting.paused, greeting.speed);
    this.setLive(true);
  }

  setLive(isLive: boolean): void {
    this.isLive = isLive;
    this.refresh();
  }

  /** `isAllowed`: the role of this page may change the room. */
  setAllowed(isAllowed: boolean): void {
    this.isAllowed = isAllowed;
    byId("room-box").hidden = !isAllowed;
    this.refresh();
  }

  private refresh(): void {
    const isOff = !this.isLive || !this.isAllowed;
    this.pause.disabled = this.reset.disabled = this.scenes.disabled = this.fidelity.disabled = this.speedRow.disabled = isOff;
    this.step.disabled = isOff || !this.paused;
    this.step.title = this.paused ? kTexts.oneTick : kTexts.pauseFirst;
  }

  roomState(paused: boolean, speed: number): void {
    this.paused = paused;
    setText(this.pause, paused ? kTexts.commands.resume : kTexts.commands.pause);
    this.pause.setAttribute("aria-pressed", String(paused));
    if (speed > 0) {
      this.speed.setServerValue(speed);
      this.fidelity.setSpeed(speed);
    }
    this.setLive(this.isLive);
  }

  diagnostics(diagnostics: DiagnosticsInfo, nowS: number): void {
    this.fidelity.diagnostics(diagnostics, nowS);
  }

  ack(commandId: number): void {
    this.speed.ack(commandId);
    this.fidelity.ack(commandId);
    if (commandId === this.changeId) this.changed();
  }

  reject(commandId: number, message: string): void {
    this.speed.reject(commandId, message);
    this.fidelity.reject(commandId, message);
    if (commandId !== this.changeId) return;
    this.scenes.value = this.sceneName;
    this.changed();
  }

  /** This page waits for the answer to its own change of scene or fidelity. */
  get isChanging(): boolean {
    return this.changeId !== 0 || this.fidelity.isChanging;
  }

  private changed(): void {
    this.changeId = 0;
    this.opening.hidden = true;
  }
}

/** Name of a scene in the list: its title where the language has one. */
export function sceneLabel(name: string): string {
  return kTexts.scenes[name]?.title ?? name.replaceAll("_", " ");
}
