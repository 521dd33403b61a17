// The page's root: puts worker, scene and panels together and runs the display loop.
import { Vector3, WebGLRenderer } from "three";

import "./style.css";
import type { GreetingInfo } from "./codec/greeting";
import type { RoleName } from "./codec/people";
import { IdentityStore } from "./net/identity_store";
import type { CommandAction, ConnectionState, LinkStats } from "./net/messages";
import { socketUrl, WaterClient, type WorkerLike } from "./net/water_client";
import { CameraViews, type Followed, type ViewName } from "./scene/camera_views";
import { FrameGovernor } from "./scene/frame_governor";
import type { PixelRect } from "./scene/framing";
import { elevationRangeM } from "./scene/height_field";
import { pickWater } from "./scene/pick";
import { chooseQuality, type ChosenQuality } from "./scene/quality";
import { WaterScene } from "./scene/water_scene";
import { addDetailRow } from "./ui/detail_row";
import { byId, isTyping, setText } from "./ui/dom";
import { BoatPanel } from "./ui/boat_panel";
import { EffectsPanel } from "./ui/effects_panel";
import { describeState, Hud } from "./ui/hud";
import { ParametersPanel } from "./ui/parameters_panel";
import { PeoplePanel } from "./ui/people_panel";
import { RoomPanel } from "./ui/room_panel";
import { TapDetector, toDeviceCoordinates } from "./ui/tap";
import { Toast } from "./ui/toast";

const nowS = (): number => performance.now() / 1000;
const canvas = byId<HTMLCanvasElement>("view");
const notice = byId("notice");
/** As in style.css: below this width the panel is a sheet at the bottom. */
const kNarrowPx = 760;
const kHelmLabel = "Helm";
const reducedMotion = (): boolean => window.matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Reading it throws where the browser forbids it. */
function sessionStorageIfAny(): Storage | undefined {
  try {
    return window.sessionStorage;
  } catch {
    return undefined;
  }
}

function showNotice(text: string): void {
  setText(byId("notice-text"), text);
  notice.hidden = text === "";
}

/** The renderer and what draws underneath; undefined where this browser cannot. */
function makeRenderer(): { renderer: WebGLRenderer; quality: ChosenQuality } | undefined {
  // A scratch context tells what draws before the real one fixes its antialiasing.
  const scratch = document.createElement("canvas").getContext("webgl2");
  if (!scratch?.getExtension("EXT_color_buffer_float")) return undefined;
  const unmasked = scratch.getExtension("WEBGL_debug_renderer_info");
  const name = String(scratch.getParameter(unmasked ? unmasked.UNMASKED_RENDERER_WEBGL : scratch.RENDERER));
  scratch.getExtension("WEBGL_lose_context")?.loseContext();
  const quality = chooseQuality(location.search, name);
  try {
    const antialias = quality.samplesCount > 1;
    return { renderer: new WebGLRenderer({ canvas, antialias, powerPreference: "high-performance" }), quality };
  } catch {
    // three has said why on the console; the page says what to do.
    return undefined;
  }
}

function main(): void {
  const made = makeRenderer();
  if (!made) {
    showNotice(
      "This page needs WebGL 2 with floating-point targets, and this browser offers none. Turn on hardware acceleration, or try a current Firefox, Chrome, Edge or Safari.",
    );
    return;
  }
  const { renderer, quality } = made;
  document.body.classList.toggle("plain", quality.samplesCount === 1);
  const governor = new FrameGovernor(Math.min(window.devicePixelRatio || 1, quality.maxPixelRatio), quality.adaptive);

  const hud = new Hud();
  const toast = new Toast(byId("toast"));
  const url = socketUrl(location);
  const identities = new IdentityStore(sessionStorageIfAny(), url);
  let identity = identities.load();
  let greeting: GreetingInfo | undefined;
  /** Unknown until the server's welcome: nothing is offered before. */
  let role: RoleName = "viewer";
  let state: ConnectionState = { name: "connecting" };
  let link: LinkStats | undefined;
  let simTimeS = 0;
  let lastAck: { commandId: number; appliedTick: number } | null = null;
  /** Particles without a wave say how high they stand with their first frame only. */
  let isExtentKnown = true;
  const sentLabels = new Map<number, string>();

  const worker = new Worker(new URL("./net/worker.ts", import.meta.url), { type: "module" });
  const client = new WaterClient(worker as unknown as WorkerLike, {
    state: (message) => {
      state = message.state;
      hud.connection(state);
      // Greeting and welcome follow and turn everything on: what there is to do depends on scene and role.
      showEffectButtons();
      if (state.name === "live") return;
      room.setLive(false);
      boats.setLive(false);
    },
    greeting: (message) => enter(message.greeting),
    frame: ({ frame }) => {
      simTimeS = frame.timeS;
      scene.take(frame, nowS());
      if (isExtentKnown) return;
      const extent = scene.extent();
      isExtentKnown = extent !== undefined;
      if (extent) views.measured(extent);
    },
    diagnostics: ({ diagnostics }) => hud.diagnostics(diagnostics),
    ack: ({ commandId, appliedTick, boatId }) => {
      lastAck = { commandId, appliedTick };
      hud.acked(commandId, appliedTick);
      parameters.ack(commandId);
      room.ack(commandId);
      boats.ack(commandId, boatId);
      const label = takeLabel(commandId);
      // Twenty a second would say nothing to anybody.
      if (label !== kHelmLabel) toast.show(`${label}: applied at tick ${appliedTick}`, "good");
    },
    reject: ({ commandId, reason, message }) => {
      boats.reject(commandId, reason);
      parameters.reject(commandId, message);
      room.reject(commandId, message);
      toast.show(`${takeLabel(commandId)}: ${message}`, "bad");
    },
    parameterChanged: ({ path, value }) => parameters.serverSays(path, value),
    roomState: (message) => room.roomState(message.paused, message.speed),
    welcome: ({ welcome }) => {
      identity = { ...identity, resumeKey: welcome.resumeKey };
      role = welcome.role;
      people.welcomed(welcome);
      boats.welcomed(welcome.personId, welcome.resumed);
      showRole();
    },
    people: (message) => {
      people.setPeople(message.people);
      boats.setPeople(message.people);
    },
    boatList: (message) => {
      scene.setBoats(message.boats);
      boats.setBoats(message.boats);
    },
    roomEvent: ({ event, message }) => {
      const said = message || { recovered: "The water was put back to its last good state.", reset: "The scene started again.", other: "Something happened." }[event];
      toast.show(said, event === "recovered" ? "warn" : "good");
    },
    clock: ({ leadS }) => scene.clock.sync(leadS + performance.timeOrigin / 1000),
    stats: (message) => {
      link = message.stats;
      hud.link(link);
    },
  });
  const scene = new WaterScene(renderer, quality, (frame) => client.release(frame));
  const views = new CameraViews(scene.camera, canvas, reducedMotion);
  const effects = new EffectsPanel(byId("effects"));
  const parameters = new ParametersPanel(byId("parameters"), (action) => send(action, "Parameter"), { "storm.level_ratio": byId("storm") });
  const room = new RoomPanel(send);
  const boats = new BoatPanel(send, (boatId) => scene.poseOf(boatId), () => {
    if (boats.mineId === 0 && views.view === "boat") showView("overview");
    showPressed();
  });
  const people = new PeoplePanel(identity, (name, token) => {
    identity = { ...identity, name, token };
    identities.save(identity);
    client.introduce(name, token);
  });
  addDetailRow((detail) => client.setDetail(detail));
  const effectButtons = ["splash", "wave"].map((id) => byId<HTMLButtonElement>(id));
  const viewNames: ViewName[] = ["splash", "wave", "overview", "boat"];

  function showEffectButtons(): void {
    for (const button of effectButtons) button.disabled = state.name !== "live" || !effects.available || role === "viewer";
  }

  function showRole(): void {
    showEffectButtons();
    boats.setAllowed(role !== "viewer");
    room.setAllowed(role === "operator");
    byId("parameters-box").hidden = !parameters.hasRows || role !== "operator";
    byId("storm").hidden = role !== "operator";
  }

  function send(action: CommandAction | undefined, label: string): number {
    if (!action) return 0;
    const commandId = client.command(action);
    sentLabels.set(commandId, label);
    return commandId;
  }

  /** Every command is answered exactly once, so the map empties itself. */
  function takeLabel(commandId: number): string {
    const label = sentLabels.get(commandId) ?? `Command ${commandId}`;
    sentLabels.delete(commandId);
    return label;
  }

  function showView(name: ViewName): void {
    views.go(name, nowS());
    showPressed();
  }

  function showPressed(): void {
    for (const name of viewNames) byId(`view-${name}`).setAttribute("aria-pressed", String(views.view === name));
    byId<HTMLButtonElement>("view-boat").disabled = boats.mineId === 0;
    document.body.classList.toggle("boat-view", views.view === "boat");
  }

  const followed: Followed = { xM: 0, yM: 0, zM: 0, headingRad: 0, lengthM: 1 };
  function followedBoat(): Followed | undefined {
    const pose = boats.mineId ? scene.poseOf(boats.mineId) : undefined;
    if (!pose) return undefined;
    followed.xM = pose.xM;
    followed.yM = pose.yM;
    followed.zM = pose.zM;
    followed.headingRad = pose.headingRad;
    followed.lengthM = boats.lengthOf(boats.mineId);
    return followed;
  }

  function enter(entered: GreetingInfo): void {
    const sameWater = greeting?.sideM === entered.sideM && greeting.room === entered.room && greeting.sceneName === entered.sceneName;
    greeting = entered;
    scene.enter(entered);
    if (!sameWater) {
      const extent = scene.extent();
      isExtentKnown = extent !== undefined;
      views.enter(extent ?? { sideM: entered.sideM, minYM: -0.25 * entered.sideM, maxYM: 0 });
    }
    effects.enter(entered);
    parameters.enter(entered.parameters);
    byId("effects-box").hidden = byId("effect-buttons").hidden = !effects.available;
    setText(byId("title"), entered.title);
    setText(byId("description"), entered.description);
    document.title = `${entered.title} – Spindrift`;
    hud.enter(entered);
    room.enter(entered);
    boats.enter(entered);
    byId("view-boat").hidden = !boats.available;
    showRole();
    showPressed();
    // The card has this scene's text now, and its height.
    resize();
  }

  byId("splash").addEventListener("click", () => send(effects.splashAt(0, 0), "Splash"));
  byId("wave").addEventListener("click", () => send(effects.breakingWave(), "Wave"));
  for (const name of viewNames) byId(`view-${name}`).addEventListener("click", () => showView(name));
  canvas.addEventListener("pointerup", showPressed);
  byId("retry").addEventListener("click", () => client.retryNow());
  const panelToggle = byId("panel-toggle");
  const setPanelOpen = (open: boolean): void => {
    document.body.classList.toggle("panel-closed", !open);
    panelToggle.setAttribute("aria-expanded", String(open));
    panelToggle.setAttribute("aria-label", open ? "Hide controls" : "Show controls");
    resize();
  };
  panelToggle.addEventListener("click", () => setPanelOpen(document.body.classList.contains("panel-closed")));
  setPanelOpen(window.innerWidth > kNarrowPx);

  const taps = new TapDetector();
  const sample = (event: PointerEvent) => ({ id: event.pointerId, xPx: event.clientX, yPx: event.clientY, timeMs: event.timeStamp });
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button === 0) taps.pressed(sample(event));
  });
  canvas.addEventListener("pointercancel", (event) => taps.cancelled(event.pointerId));
  canvas.addEventListener("pointerup", (event) => {
    if (!taps.released(sample(event))) return;
    const at = toDeviceCoordinates(event.clientX, event.clientY, canvas.getBoundingClientRect());
    const shape = scene.shape();
    if (!shape) return;
    const direction = new Vector3(at.x, at.y, 0.5).unproject(scene.camera).sub(scene.camera.position).normalize();
    const place = pickWater({ originM: scene.camera.position.toArray(), direction: direction.toArray() }, shape);
    if (place) send(effects.splashAt(place.xM, place.zM), `Splash at ${place.xM.toFixed(1)}, ${place.zM.toFixed(1)} m`);
  });

  function resize(): void {
    renderer.setPixelRatio(governor.pixelRatio);
    renderer.setSize(window.innerWidth, window.innerHeight, false);
    views.resize(window.innerWidth, window.innerHeight, freePart());
  }

  /** What card and panel leave of the canvas: beside and under them, on narrow screens between them. */
  function freePart(): PixelRect {
    const widthPx = window.innerWidth;
    const heightPx = window.innerHeight;
    const open = !document.body.classList.contains("panel-closed");
    const narrow = widthPx <= kNarrowPx;
    const panel = byId("panel").getBoundingClientRect();
    const card = byId("card").getBoundingClientRect();
    return {
      leftPx: 0,
      // The far side of the water is narrow: the card's corner may hang a little into the free part.
      topPx: narrow ? card.bottom : 0.7 * card.bottom,
      rightPx: open && !narrow ? panel.left : widthPx,
      bottomPx: open && narrow ? panel.top : heightPx,
    };
  }
  window.addEventListener("resize", resize);
  document.addEventListener("visibilitychange", () => {
    client.setVisible(!document.hidden);
    if (document.hidden) boats.leaveHelm();
  });
  window.addEventListener("pagehide", () => identities.leave(identity));
  // Back from the browser's memory of pages, not loaded anew: the key is this page's again.
  window.addEventListener("pageshow", ({ persisted }) => persisted && identities.save(identity));
  window.addEventListener("blur", () => boats.leaveHelm());
  // The helm's keys, while the boat's view shows and nobody moves a slider or a list with them.
  window.addEventListener("keydown", (event) => {
    if (views.view !== "boat" || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey || isTyping(event.target)) return;
    if (boats.key(event.code, true)) event.preventDefault();
  });
  window.addEventListener("keyup", (event) => boats.key(event.code, false));

  let contextLost = false;
  canvas.addEventListener("webglcontextlost", () => {
    contextLost = true;
    showNotice("The graphics context was lost; the picture comes back as soon as the browser restores it.");
  });
  canvas.addEventListener("webglcontextrestored", () => {
    contextLost = false;
    scene.contextRestored();
    showNotice("");
  });

  let lastFrameMs = performance.now();
  let framesShown = 0;
  let fpsSinceMs = lastFrameMs;
  let displayFps = 0;
  renderer.setAnimationLoop(() => {
    if (contextLost) return;
    const frameMs = performance.now() - lastFrameMs;
    lastFrameMs += frameMs;
    if (governor.note(frameMs)) resize();
    boats.update(nowS());
    views.update(nowS(), followedBoat());
    scene.render(nowS());
    ++framesShown;
    if (lastFrameMs - fpsSinceMs >= 500) {
      displayFps = (framesShown * 1000) / (lastFrameMs - fpsSinceMs);
      framesShown = 0;
      fpsSinceMs = lastFrameMs;
      hud.display(displayFps, scene.clock.delayS(), [quality.remark, governor.remark()].filter(Boolean).join("; "));
    }
  });

  function drawnBoats() {
    const drawn = scene.drawnBoats();
    return drawn ? drawn.poses.slice(0, drawn.count).map((pose) => ({ ...pose })) : [];
  }

  // For tests and the curious: real values, read-only.
  const spindrift = {
    stats: () => {
      const surface = scene.newestSurface();
      const range = surface && elevationRangeM(surface);
      return {
        framesReceived: { surface: 0, particles: 0, foam: 0, bodies: 0, diagnostics: 0, ...link?.receivedCount },
        malformedCount: link?.malformedCount ?? 0,
        overtakenCount: link?.overtakenCount ?? 0,
        latencyMs: link?.latencyMs ?? null,
        level: link?.level ?? null,
        levelHeldBy: link?.levelHeldBy ?? null,
        surfaceResolutionCount: surface?.resolutionCount ?? null,
        delayMs: 1000 * (scene.clock.delayS() ?? NaN),
        simTime: simTimeS,
        lastAck,
        minElevationM: range?.minM ?? null,
        maxElevationM: range?.maxM ?? null,
        connectionState: describeState(state),
        displayFps,
        pixelRatio: governor.pixelRatio,
        paused: room.paused,
        boats: drawnBoats(),
        role,
        myBoat: boats.mineId,
        view: views.view ?? null,
      };
    },
  };
  Object.defineProperty(window, "spindrift", { value: Object.freeze(spindrift) });

  hud.connection(state);
  resize();
  client.start(url, identity);
}

main();
