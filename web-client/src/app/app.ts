// The page: connects the client in the worker, the display and the panels. handlers() takes the messages of the server and the worker;
// input.ts calls the methods for the user's actions.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { RoleName } from "../../client/codec/people";
import { GroundRequests } from "../net/ground_request";
import { IdentityStore, sessionStorageIfAny } from "../net/identity_store";
import type { ConnectionState } from "../../client/session/events";
import type { LinkStats, PageEventHandlers } from "../net/messages";
import { roomOf, wishOf } from "../net/room_address";
import { openWaterClient, socketUrl } from "../net/water_client";
import { markTopM } from "../scene/boats/course_marks";
import { chooseQuality, firstTier, kTiers } from "../scene/drawing/quality";
import type { MadeRenderer } from "../scene/drawing/renderer";
import { BoatPanel } from "../ui/boat_panel";
import { BoatTags } from "../ui/boat_tags";
import { CourseTags } from "../ui/course_tags";
import { addDetailRow } from "../ui/detail_row";
import { byId, setText } from "../ui/dom";
import { DrawingRow } from "../ui/drawing_row";
import { EffectsPanel } from "../ui/effects_panel";
import { nextMarkOf } from "../ui/game_texts";
import { FingerTags } from "../ui/finger_tags";
import { FloaterRows } from "../ui/floater_rows";
import { LessonState, lessonToolOf } from "../ui/lesson_state";
import { Hud } from "../ui/hud";
import { LightRows, lightOf } from "../ui/light_rows";
import { PageActions } from "../ui/page_actions";
import { ParametersPanel } from "../ui/parameters_panel";
import { PeoplePanel } from "../ui/people_panel";
import { QualityRow } from "../ui/quality_row";
import { RoomNews } from "../ui/room_news";
import { RoomPanel } from "../ui/room_panel";
import { kTexts } from "../ui/texts";
import { ToolBar } from "../ui/tool_bar";
import { ToolPreview, type Outline } from "../ui/tool_preview";
import { Toast } from "../ui/toast";
import type { WaterPlace } from "../ui/tools";
import { ViewButtons } from "../ui/view_buttons";
import { currentAddress, isEmbeddedAddress, isKioskAddress, isProjectorAddress, setAddressParameter, takeLinkToken } from "./address";
import { CommandSender } from "./command_sender";
import { Display } from "./display";
import { Gauges } from "./gauges";
import { Haptics } from "./haptics";
import { LookControls } from "./look_controls";
import { nowS } from "./picture_clock";
import { PictureControls } from "./picture_controls";
import { waterInMiddle } from "./pointer_ray";
import { removePoster, showPanels } from "./poster";
import { SoundControls } from "./sound_controls";
import { leadToFront } from "./to_front";
import { ViewAddress } from "./view_address";

const kNextMarkColor = "#ffe14d";

/** Takes the answers to its own commands and ignores the others. */
interface AnswerListener {
  ack(commandId: number, boatId: number, floaterId: number): void;
  reject(commandId: number, message: string, reason: string): void;
}

export class App {
  readonly client = openWaterClient(this.handlers());
  readonly commands = new CommandSender(this.client);
  readonly display: Display;
  readonly effects = new EffectsPanel(byId("effects"));
  readonly drawing = new DrawingRow();
  readonly floaterRows: FloaterRows = new FloaterRows(byId("kinds"), byId("object-rows"), this.commands.send);
  readonly tools = new ToolBar(byId("tools"), byId("tool-rows"), () => this.drawing.describeTurning(), (name) => this.floaterRows.show(name === "float"));
  readonly room = new RoomPanel(this.commands.send);
  readonly haptics = new Haptics();
  readonly sound: SoundControls;
  /** The buttons beside the panel. */
  readonly actions = new PageActions();
  private readonly pictures: PictureControls;
  readonly boats: BoatPanel;
  readonly viewButtons: ViewButtons;
  private readonly viewAddress: ViewAddress | undefined;
  /** Its role is "viewer" until the server's Welcome, so that no control is enabled before. */
  readonly lessons = new LessonState();
  state: ConnectionState = { name: "connecting" };
  link: LinkStats | undefined;
  supersededCount = 0;
  simTimeS = 0;
  simTick = 0;
  lastAck: { commandId: number; appliedTick: number } | null = null;

  private readonly hud = new Hud();
  private readonly toast = new Toast(byId("toast"), !isEmbeddedAddress(location));
  private readonly news = new RoomNews({
    say: (text, tone) => this.toast.show(text, tone),
    nameOf: (personId) => this.lessons.personOf(personId)?.name,
    ownId: () => this.lessons.ownId,
    isChanging: () => this.room.isChanging,
  });
  private readonly parameters = new ParametersPanel(byId("parameters"), (action) => this.commands.send(action, kTexts.commands.parameter), { "storm.level_ratio": byId("storm") });
  private readonly people: PeoplePanel;
  private readonly tags = new BoatTags(byId("view"));
  private readonly marks = new CourseTags(byId("view"), markTopM);
  readonly fingers = new FingerTags(byId("view"));
  private readonly gauges: Gauges;
  private readonly preview = new ToolPreview(byId("view"));
  private readonly lightRows: LightRows;
  private readonly looks: LookControls;
  private readonly qualityRow: QualityRow;
  readonly answerListeners: AnswerListener[];
  /** The water is drawn over a level bed until the ground is there. */
  private readonly ground = new GroundRequests(
    (room) => this.client.requestGround(room, this.identity.token),
    (room, ground) => {
      if (this.entered?.room === room && this.entered.hasBed) this.display.scene.setGround(ground);
    },
    (message) => this.toast.show(message, "bad"),
  );
  private readonly url = socketUrl(location.href);
  /** All frames of a page share its store: what one is given would be the others', too. */
  private readonly identities = new IdentityStore(isEmbeddedAddress(location) ? undefined : sessionStorageIfAny(), this.url);
  private identity = this.identities.load(takeLinkToken(location, history));
  /** The last greeting. */
  entered: GreetingInfo | undefined;
  /** Called before a room is entered; set by input.ts, as the next four. */
  entering: () => void = () => {};
  poll: (atS: number) => void = () => {};
  /** What the tool at the pointer acts on. */
  outline: () => Outline | undefined = () => undefined;
  /** Turns what is held, positive from +x toward +z; false if nothing is. */
  turnHeld: (angleRad: number) => boolean = () => false;
  /** Called when the room has another value of a parameter; set by changed_values.ts. */
  parameterChanged: () => void = () => {};
  /** Lifts all fingers and leaves the helm; set by input.ts. */
  letGo: () => void = () => {};
  /** Takes the next tap on the water, in place of the tool; set by gauge_view.ts. */
  placing: ((place: WaterPlace) => void) | undefined;
  /** Takes the object out of the water that is held or pointed at. */
  removePointed: () => void = () => {};

  constructor({ renderer, isSoftwareRenderer, texelType }: MadeRenderer) {
    const isHandheld = window.matchMedia("(pointer: coarse)").matches;
    const quality = { first: firstTier(isSoftwareRenderer, isHandheld), choice: chooseQuality(location.search), texelType };
    this.display = new Display(renderer, quality, {
      release: (frame) => this.client.release(frame),
      update: (atS) => {
        this.poll(atS);
        return this.boats.update(atS);
      },
      drawn: (atS) => {
        if (this.display.scene.shownTimeS !== undefined) removePoster();
        this.showTags(atS);
        this.looks.update(atS);
        this.viewAddress?.update(atS);
        this.sound.update();
        this.pictures.drawn();
        this.haptics.follow(this.display.scene, this.entered, this.boats.mineId);
      },
      measured: (framesPerS, delayS) => this.hud.display(framesPerS, delayS),
      qualityChanged: () => this.showQuality(),
    });
    this.gauges = new Gauges(this.display, () =>
      import("./gauge_view").then(({ makeGaugeView }) => makeGaugeView(this), () => void this.warn(kTexts.gaugesNotLoaded)),
    );
    this.pictures = new PictureControls(this.display, this.actions, (why) => this.toast.show(why, "bad"));
    this.sound = new SoundControls(this.display, this.haptics, (why) => this.toast.show(why, "bad"));
    this.boats = new BoatPanel(this.commands.send, (boatId) => this.display.scene.poseOf(boatId), () => waterInMiddle(this.display), () => this.viewButtons.boatChanged());
    // The camera of a projector or a kiosk moves by itself.
    this.viewAddress = isProjectorAddress(location) || isKioskAddress(location) ? undefined : new ViewAddress(this.display.views, this.display.scene.camera.position);
    this.viewButtons = new ViewButtons(this.display.views, nowS, () => this.boats.mineId);
    this.people = new PeoplePanel(this.identity, (name, token) => {
      this.identity = { ...this.identity, name, token };
      this.keepIdentity(false);
      this.client.call("introduce", name, token);
    });
    this.lightRows = new LightRows(this.display.scene.daylight, lightOf(location.search), (light) => setAddressParameter("light", light));
    this.looks = new LookControls(this.display, (exactParticles) => this.client.want({ exactParticles }));
    this.qualityRow = new QualityRow(isSoftwareRenderer, (choice) => {
      setAddressParameter("quality", choice === "automatic" ? undefined : choice);
      this.display.chooseQuality(choice);
      this.showQuality();
    });
    this.qualityRow.show(this.display.quality);
    addDetailRow((detail) => this.client.want({ detail }));
    this.answerListeners = [this.parameters, this.room, this.boats];
    this.lessons.watch(() => {
      const { game } = this.lessons;
      this.display.scene.setGame(game?.kind, this.nextMark);
      this.marks.setGame(game?.kind);
      this.tags.setPlaces(game);
      this.showRole();
    });
  }

  get role(): RoleName {
    return this.lessons.role;
  }

  /** Empty without one. */
  get token(): string {
    return this.identity.token;
  }

  /** The page's address with all that was chosen up to now. */
  get address(): string {
    this.viewAddress?.writeNow(nowS());
    return currentAddress();
  }

  /** `isDrawing`: at display rate. */
  start(isDrawing: boolean): void {
    this.hud.connection(this.state);
    this.display.start(isDrawing);
    this.client.start(this.url, this.identity, wishOf(location.search));
  }

  /** Stores the identity for a reload; with the resume key only while no page uses it. */
  keepIdentity(withResumeKey: boolean): void {
    if (withResumeKey) this.identities.leave(this.identity);
    else this.identities.save(this.identity);
  }

  /** Shows a line about something that does not work as wanted. */
  warn(text: string): void {
    this.toast.show(text, "warn");
  }

  private handlers(): PageEventHandlers {
    return {
      state: ({ state }) => {
        this.state = state;
        this.hud.connection(state);
        if (state.name === "retrying" || state.name === "refused") showPanels();
        if (state.name !== "live") {
          this.fingers.clear();
          for (const panel of [this.room, this.boats]) panel.setLive(false);
        }
        this.showRole();
        // Frames, projectors and kiosks show what they were given.
        if (state.name === "refused" && state.rooms.length > 0 && ![isEmbeddedAddress, isProjectorAddress, isKioskAddress].some((isOne) => isOne(location))) leadToFront(roomOf(location.search), state.reason);
      },
      greeting: ({ greeting }) => this.enter(greeting),
      welcome: ({ welcome }) => {
        this.identity = { ...this.identity, resumeKey: welcome.resumeKey };
        this.people.welcomed(welcome);
        this.boats.welcomed(welcome.personId, welcome.resumed);
        this.lessons.set({ role: welcome.role, ownId: welcome.personId });
      },
      frame: ({ frame }) => {
        this.simTimeS = frame.timeS;
        this.simTick = Number(frame.tick);
        this.display.take(frame);
        this.sound.take(frame.layer);
      },
      diagnostics: ({ diagnostics }) => {
        this.hud.diagnostics(diagnostics);
        this.room.diagnostics(diagnostics, nowS());
        this.gauges.take(diagnostics);
      },
      ack: ({ boatId, floaterId, ...ack }) => {
        const commandId = Number(ack.commandId);
        const appliedTick = Number(ack.appliedTick);
        this.lastAck = { commandId, appliedTick };
        this.hud.acked(commandId, appliedTick);
        for (const listener of this.answerListeners) listener.ack(commandId, boatId, floaterId);
        this.commands.takeLabel(commandId);
      },
      reject: ({ reason, message, ...reject }) => {
        const commandId = Number(reject.commandId);
        for (const listener of this.answerListeners) listener.reject(commandId, message, reason);
        const label = this.commands.takeLabel(commandId);
        // What the lesson forbids is a rule, no failure of a command.
        this.toast.show(reason === "NOT_NOW" ? message || kTexts.notNow : kTexts.failed(label, message), "bad");
      },
      parameterChanged: ({ path, value }) => {
        this.parameters.setServerValue(path, value);
        this.display.scene.setParameter(path, value);
        this.parameterChanged();
        if (path === "wave.depth_m" && this.entered?.hasBed) this.ground.ask(this.entered.room);
      },
      roomState: (state) => {
        this.room.roomState(state.paused, state.speed);
        this.hud.paused(state.paused);
        this.news.state(state);
      },
      people: ({ people, unlistedCount }) => {
        this.people.setPeople(people, unlistedCount);
        this.boats.setPeople(people);
        this.tags.setPeople(people);
        this.fingers.setPeople(people);
        this.display.scene.setPeople(people);
        this.lessons.set({ people });
      },
      lesson: ({ lesson }) => this.lessons.set({ lesson }),
      game: ({ game }) => this.lessons.set({ game }),
      strokes: ({ fingers }) => {
        this.fingers.take(fingers);
        this.sound.setFingers(fingers);
      },
      boatList: ({ boats }) => {
        this.display.scene.setBoats(boats);
        this.boats.setBoats(boats);
        this.tags.setBoats(boats);
      },
      draining: ({ draining }) => this.toast.show(draining.goTo === "" ? kTexts.restarts : kTexts.moves, "warn"),
      roomEvent: (event) => this.news.event(event),
      clock: ({ leadS }) => this.display.scene.clock.sync(leadS + performance.timeOrigin / 1000),
      stats: ({ stats, supersededCount }) => {
        this.link = stats;
        this.supersededCount = supersededCount;
        this.hud.link(stats);
      },
    };
  }

  private enter(greeting: GreetingInfo): void {
    if (this.entered?.room !== greeting.room || this.entered.sceneName !== greeting.sceneName) this.entering();
    const isOtherRoom = this.entered?.room !== greeting.room;
    this.entered = greeting;
    this.display.enter(greeting);
    this.effects.enter(greeting);
    this.parameters.enter(greeting.parameters);
    byId("effects-box").hidden = byId("effect-buttons").hidden = !this.effects.available;
    const { title, description } = kTexts.scenes[greeting.sceneName] ?? greeting;
    setText(byId("title"), title);
    setText(byId("description"), description);
    document.title = `${title} – Spindrift`;
    this.hud.enter(greeting);
    this.hud.paused(greeting.paused);
    this.news.enter(greeting);
    this.room.enter(greeting);
    this.pictures.enter(greeting);
    this.boats.enter(greeting);
    this.tags.setBoats(greeting.boats);
    this.marks.enter(greeting.course);
    this.gauges.enter(greeting);
    this.fingers.clear();
    this.lightRows.showHour();
    this.looks.enter(greeting);
    this.sound.enter(greeting);
    // Not before: the connection exists from now on.
    this.showQuality();
    this.viewButtons.hasBoats = this.boats.available;
    this.viewButtons.canDive = this.display.views.canDive;
    this.viewAddress?.enter(nowS());
    // Tells all that depend on the lesson, the role or the scene.
    if (isOtherRoom) this.lessons.enter();
    else this.lessons.set({});
    this.viewButtons.refresh();
    // The card's height has changed with the text.
    this.display.resize();
    if (greeting.hasBed) this.ground.ask(greeting.room);
  }

  /** Index of the mark that one's own boat has to round. */
  private get nextMark(): number | undefined {
    return nextMarkOf(this.lessons.game, this.lessons.ownId);
  }

  /** The server takes effects from this visitor now. */
  get mayDraw(): boolean {
    return this.state.name === "live" && this.role !== "viewer" && this.effects.available;
  }

  /** There are objects that this visitor may move. */
  get hasFloaters(): boolean {
    return this.mayDraw && this.entered?.hasFloaters === true;
  }

  /** Shows the quality that is drawn, and asks for as many frames as it needs. */
  private showQuality(): void {
    const { quality } = this.display;
    this.qualityRow.show(quality);
    this.client.want({ frameRateHz: kTiers[quality.tier].frameRateMaxHz });
  }

  private showTags(atS: number): void {
    const { scene, views, covered } = this.display;
    this.fingers.update(scene.camera, scene.ripple.down(), this.lessons.ownId, scene.heightAtM, covered, atS);
    const own = this.mayDraw ? this.outline() : undefined;
    const { nextMark } = this;
    const mark = nextMark === undefined ? undefined : this.entered?.course?.marks[nextMark];
    const next: Outline[] = mark ? [{ kind: "disc", at: mark, radiusM: mark.radiusM, color: kNextMarkColor }] : [];
    this.marks.update(scene.camera, nextMark, scene.heightAtM, covered);
    this.gauges.update();
    this.preview.update([...(own ? [own] : []), ...next, ...this.fingers.discs()], scene.camera, scene.heightAtM);
    this.tags.update(scene.camera, (boatId) => scene.poseOf(boatId), views.view === "boat" ? this.boats.mineId : 0, covered);
  }

  /** Enables and shows the controls that this role may use. */
  private showRole(): void {
    const isPlayer = this.role !== "viewer";
    const isOperator = this.role === "operator";
    const { lessons } = this;
    this.effects.setEnabled(this.state.name === "live" && isPlayer, (effect) => lessons.whyNot(effect));
    this.drawing.setAllowed(this.mayDraw);
    this.tools.setAllowed(this.mayDraw, isOperator, this.hasFloaters, (tool) => lessons.whyNot(lessonToolOf(tool)));
    this.floaterRows.setAllowed(this.hasFloaters, isOperator);
    this.boats.setAllowed(isPlayer, isPlayer ? lessons.whyNot("boat") : undefined);
    this.room.setAllowed(isOperator);
    byId("parameters-box").hidden = !this.parameters.hasRows || !isOperator;
    byId("storm").hidden = !isOperator;
  }
}
