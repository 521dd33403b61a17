// The pad's root, for phones of people who look at the water on a projector: connects the client in the worker, the map, the tools and the
// helm. It asks for coarse frames at a low rate, so that a class of pads costs the server little.
import "./pad.css";
import { takeLinkToken } from "../app/address";
import { CommandSender } from "../app/command_sender";
import { Haptics } from "../app/haptics";
import { connectKeyboardTools } from "../app/keyboard_tools";
import { GamepadTools } from "../app/virtual_pointer";
import type { GreetingInfo } from "../../client/codec/greeting";
import type { LessonTool } from "../../client/codec/lesson";
import type { FingerInfo } from "../../client/codec/strokes";
import { IdentityStore, sessionStorageIfAny } from "../net/identity_store";
import type { CommandAction, ConnectionState } from "../../client/session/events";
import type { PageEventHandlers } from "../net/messages";
import { openWaterClient, socketUrl } from "../net/water_client";
import { setText } from "../ui/dom";
import { kTeamColors } from "../ui/game_texts";
import { describeState } from "../ui/hud";
import { keepChoice, keptChoice } from "../ui/kept";
import { kPageTime } from "../ui/latest_sender";
import { LessonState } from "../ui/lesson_state";
import { kStrokeLabel } from "../ui/stroke_sender";
import { kHoldLabel } from "../ui/hold_sender";
import { friendlyName } from "./friendly_name";
import { gameTouch, kPatterns } from "./game_touch";
import { kPadHelmLabel, PadBoat } from "./pad_boat";
import { PadHands, type Preview } from "./pad_hands";
import { makePadLayout } from "./pad_layout";
import { PadMap } from "./pad_map";
import { PadWords } from "./pad_words";
import { Stick } from "./stick";
import { kPadTexts } from "../ui/pad_texts";
import { kTexts } from "../ui/texts";

const kNameKey = "pad-name";
const kModeKey = "pad-mode";
/** Frames per second: while a boat is steered, and otherwise. */
const kRatesHz = { boat: 15, other: 10 };
/** Labels of commands that are sent many times per second: only the lesson's refusals are shown. */
const kQuietLabels = [kPadHelmLabel, kStrokeLabel, kHoldLabel];
const kHintMs = 3500;

export function openPad(): void {
  const pad = new PadPage();
  Object.defineProperty(window, "spindrift", { value: Object.freeze({ stats: () => pad.stats() }) });
}

class PadPage {
  private readonly elements = makePadLayout();
  private readonly lessons = new LessonState();
  private readonly client = openWaterClient(this.handlers());
  private readonly identities: IdentityStore;
  private identity;
  private readonly map = new PadMap(this.elements.canvas);
  private readonly words = new PadWords(this.elements, this.lessons);
  private readonly commands = new CommandSender(this.client);
  private readonly hands = new PadHands((action, label) => this.send(action, label), kPageTime, Math.random);
  private readonly boat = new PadBoat((action, label) => this.send(action, label), kPageTime);
  private readonly stick = new Stick((setting) => this.boat.steer(setting));
  private readonly haptics = new Haptics();
  private readonly gamepad = new GamepadTools({
    canvas: this.elements.canvas,
    isHelm: () => this.mode === "boat",
    helm: (code, isDown) => void this.boat.key(code, isDown),
    launch: () => this.elements.launch.click(),
    stepTool: (by) => this.stepTool(by),
    turnHeld: () => false,
    removePointed: () => {},
    nextKind: () => {},
    nextView: () => {},
    toggleSound: () => {},
    orbit: () => {},
  });
  private state: ConnectionState = { name: "connecting" };
  private greeting: GreetingInfo | undefined;
  private fingers: FingerInfo[] = [];
  private mode: LessonTool = "finger";
  private hintTimer = 0;
  private picturesCount = 0;
  private picturesSinceMs = performance.now();
  private picturesPerS = 0;

  constructor() {
    const url = socketUrl(location.href);
    this.identities = new IdentityStore(sessionStorageIfAny(), url);
    this.identity = this.identities.load(takeLinkToken(location, history));
    this.identity.name ||= keptChoice(kNameKey) ?? friendlyName(Math.random);
    keepChoice(kNameKey, this.identity.name);
    this.identities.save(this.identity);
    setText(this.elements.myName, this.identity.name);
    this.elements.helm.append(this.stick.element);
    this.lessons.watch(() => this.refresh());
    this.connectPage();
    this.connectMap();
    connectKeyboardTools({ canvas: this.elements.canvas, isHelm: () => this.mode === "boat", isPaddle: () => this.mode === "wave" });
    this.client.start(url, this.identity);
    this.client.want({ layers: ["surface", "bodies", "floaters"], detail: "coarse" });
    this.choose((keptChoice(kModeKey) as LessonTool | undefined) ?? "finger");
    const frame = (): void => {
      requestAnimationFrame(frame);
      this.draw();
    };
    frame();
  }

  /** Measured values for tests and the browser's console. */
  stats() {
    const { lessons, state, boat, mode, picturesPerS } = this;
    return { connectionState: describeState(state), role: lessons.role, personId: lessons.ownId, myBoat: boat.boatId, mode, displayFps: picturesPerS, whyNot: lessons.whyNot(mode) ?? null, water: this.map.counts(), simTime: this.map.simTimeS };
  }

  private handlers(): PageEventHandlers {
    const nothing = (): void => {};
    return {
      state: ({ state }) => {
        this.state = state;
        if (state.name !== "live") {
          this.fingers = [];
          this.hands.liftAll();
          this.stick.release();
        }
        this.refresh();
      },
      greeting: ({ greeting }) => this.enter(greeting),
      welcome: ({ welcome }) => {
        this.identity = { ...this.identity, resumeKey: welcome.resumeKey };
        this.lessons.set({ role: welcome.role, ownId: welcome.personId });
      },
      frame: ({ frame }) => {
        if (!this.map.take(frame)) this.client.release(frame);
      },
      ack: ({ commandId }) => {
        this.commands.takeLabel(Number(commandId));
        this.hands.answered(Number(commandId), false);
      },
      reject: ({ commandId, reason, message }) => this.rejected(Number(commandId), reason, message),
      people: ({ people }) => this.lessons.set({ people }),
      lesson: ({ lesson }) => this.lessons.set({ lesson }),
      game: ({ game }) => {
        const touch = gameTouch(this.lessons.game, game, this.lessons.ownId);
        if (touch) this.haptics.tell(kPatterns[touch]);
        this.lessons.set({ game });
      },
      strokes: ({ fingers }) => (this.fingers = fingers),
      boatList: ({ boats }) => {
        if (this.greeting) this.greeting.boats = boats;
      },
      clock: ({ leadS }) => this.map.sync(leadS + performance.timeOrigin / 1000),
      draining: () => this.hint(kPadTexts.restarts),
      roomEvent: nothing,
      roomState: nothing,
      parameterChanged: nothing,
      diagnostics: nothing,
      stats: nothing,
    };
  }

  private enter(greeting: GreetingInfo): void {
    if (this.greeting?.room !== greeting.room) this.lessons.enter();
    this.greeting = greeting;
    this.hands.liftAll();
    this.map.enter(greeting, (message) => this.client.release(message));
    if (greeting.hasBed)
      this.client.requestGround(greeting.room, this.identity.token).then(
        (ground) => this.greeting === greeting && this.map.setGround(ground),
        (error: unknown) => this.hint(error instanceof Error ? error.message : String(error)),
      );
    this.refresh();
  }

  private rejected(commandId: number, reason: string, message: string): void {
    this.hands.answered(commandId, true);
    const label = this.commands.takeLabel(commandId);
    if (reason === "NOT_NOW") this.hint(message || kTexts.notNow);
    else if (!kQuietLabels.includes(label)) this.hint(kTexts.failed(label, message));
  }

  private send(action: CommandAction, label: string): number {
    return this.state.name === "live" ? this.commands.send(action, label) : 0;
  }

  /** Tools that the room has and the lesson hands out. */
  private tools(): LessonTool[] {
    const { greeting, lessons } = this;
    const isThere = (tool: LessonTool): boolean => (tool === "boat" ? greeting?.hasBoats === true : tool === "float" || tool === "throw" ? greeting?.hasFloaters === true : true);
    return lessons.lesson.tools.filter(isThere);
  }

  private choose(mode: LessonTool): void {
    if (mode !== this.mode) {
      this.hands.liftAll();
      this.stick.release();
      this.boat.rest();
    }
    this.mode = mode;
    keepChoice(kModeKey, mode);
    this.client.want({ frameRateHz: mode === "boat" ? kRatesHz.boat : kRatesHz.other });
    this.refresh();
  }

  private stepTool(by: 1 | -1): void {
    const tools = this.tools();
    const next = tools[(tools.indexOf(this.mode) + by + tools.length) % tools.length];
    if (next) this.elements.buttons.get(next)?.click();
  }

  /** Shows what the lesson, the game and the people say. */
  private refresh(): void {
    const { elements, lessons } = this;
    const tools = this.tools();
    if (this.greeting && tools.length > 0 && !tools.includes(this.mode)) return this.choose(tools[0]!);
    const reason = this.state.name === "live" ? lessons.whyNot(tools.length > 0 ? undefined : this.mode) : undefined;
    if (reason !== undefined) {
      this.hands.liftAll();
      this.stick.release();
    }
    for (const [tool, button] of elements.buttons) {
      button.hidden = !tools.includes(tool);
      button.setAttribute("aria-pressed", String(tool === this.mode));
      button.disabled = reason !== undefined;
    }
    const { me } = lessons;
    this.boat.boatId = me?.boatIds[0] ?? 0;
    document.body.style.setProperty("--own", me?.color ?? "#5fd4e6");
    if (me?.team) document.body.style.setProperty("--team", kTeamColors[me.team]);
    else document.body.style.removeProperty("--team");
    elements.me.title = me?.team ? kTexts.teamOf(me.team) : kTexts.myName;
    elements.helm.hidden = this.mode !== "boat";
    elements.launch.hidden = this.boat.boatId !== 0;
    elements.launch.disabled = elements.remove.disabled = reason !== undefined || this.state.name !== "live";
    elements.remove.hidden = this.stick.element.hidden = this.boat.boatId === 0;
    this.words.refresh(this.state, reason);
  }

  private hint(text: string): void {
    setText(this.elements.hint, text);
    this.elements.hint.hidden = false;
    window.clearTimeout(this.hintTimer);
    this.hintTimer = window.setTimeout(() => (this.elements.hint.hidden = true), kHintMs);
  }

  private connectPage(): void {
    const { elements } = this;
    for (const [tool, button] of elements.buttons)
      button.addEventListener("click", () => {
        this.choose(tool);
        this.hint(kPadTexts.does[tool]);
      });
    elements.retry.addEventListener("click", () => this.client.call("retryNow"));
    elements.launch.addEventListener("click", () => this.greeting && this.boat.launch(this.greeting, this.map.boats()));
    elements.remove.addEventListener("click", () => this.boat.remove());
    elements.me.addEventListener("click", () => {
      elements.name.value = this.identity.name;
      elements.dialog.showModal();
      elements.name.select();
    });
    elements.form.addEventListener("submit", () => this.rename(elements.name.value.trim()));
    const leave = (): void => {
      this.hands.liftAll();
      this.stick.release();
      this.boat.rest();
    };
    document.addEventListener("visibilitychange", () => {
      this.client.want({ visible: !document.hidden });
      if (document.hidden) leave();
    });
    window.addEventListener("blur", leave);
    window.addEventListener("pagehide", () => this.identities.leave(this.identity));
    window.addEventListener("pageshow", ({ persisted }) => persisted && this.identities.save(this.identity));
    window.addEventListener("keydown", (event) => this.mode === "boat" && !event.ctrlKey && !event.altKey && !event.metaKey && !elements.dialog.open && this.boat.key(event.code, true) && event.preventDefault());
    window.addEventListener("keyup", ({ code }) => this.boat.key(code, false));
  }

  private rename(name: string): void {
    if (name === "" || name === this.identity.name) return;
    this.identity = { ...this.identity, name };
    keepChoice(kNameKey, name);
    this.identities.save(this.identity);
    setText(this.elements.myName, name);
    this.client.call("introduce", name, this.identity.token);
  }

  private connectMap(): void {
    const { canvas } = this.elements;
    const at = ({ clientX, clientY }: PointerEvent): [number, number] => {
      const { left, top } = canvas.getBoundingClientRect();
      return [clientX - left, clientY - top];
    };
    canvas.addEventListener("pointerdown", (event) => {
      const { mode } = this;
      const water = this.map.water();
      if (mode === "boat" || !water || this.state.name !== "live" || this.lessons.whyNot(mode) !== undefined) return;
      if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
      this.hands.press(event.pointerId, ...at(event), mode, water);
    });
    canvas.addEventListener("pointermove", (event) => {
      const water = this.map.water();
      // Browsers tell of coalesced events in secure contexts only.
      if (water) for (const each of event.getCoalescedEvents?.().slice(0, -1) ?? []) this.hands.move(each.pointerId, ...at(each), water);
      if (water) this.hands.move(event.pointerId, ...at(event), water);
    });
    canvas.addEventListener("pointerup", ({ pointerId }) => {
      const water = this.map.water();
      if (water) this.hands.release(pointerId, water);
    });
    canvas.addEventListener("pointercancel", ({ pointerId }) => this.hands.lift(pointerId));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  private draw(): void {
    const nowMs = performance.now();
    this.gamepad.update(nowMs / 1000);
    this.boat.update(nowMs / 1000);
    const { lessons, boat, fingers, mode } = this;
    const pose = this.map.draw(nowMs / 1000, lessons, {
      followedId: mode === "boat" ? boat.boatId : 0,
      ownBoatId: boat.boatId,
      fingers,
      ownFingers: this.hands.places(),
      previews: [...(this.greeting ? this.hands.previews(this.greeting) : []), ...this.cursor()],
    });
    this.map.feel(this.haptics, boat.boatId);
    this.words.update(this.map.simTimeS, pose);
    this.measure(nowMs);
  }

  /** Where a gamepad would use the tool. */
  private cursor(): Preview[] {
    const { cursorPx } = this.gamepad;
    const water = this.map.water();
    if (!cursorPx || !water) return [];
    const { left, top } = this.elements.canvas.getBoundingClientRect();
    return [{ kind: "ring", at: water.placeOf(cursorPx[0] - left, cursorPx[1] - top), radiusM: 0 }];
  }

  private measure(nowMs: number): void {
    ++this.picturesCount;
    const elapsedMs = nowMs - this.picturesSinceMs;
    if (elapsedMs < 1000) return;
    this.picturesPerS = (1000 * this.picturesCount) / elapsedMs;
    this.picturesCount = 0;
    this.picturesSinceMs = nowMs;
  }
}
