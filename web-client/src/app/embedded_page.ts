// `?embed`: the page as another page shows it in a frame. Without panels and toasts of success, without stored choices of its own in the
// address, and with a link to the page around it.
import { clipped, type FrameMessage, type Request } from "../../element/protocol";
import { ParentLink } from "../embed/parent_link";
import { Side } from "../../client/gen/spindrift/v1/scene_pb";
import { askParents } from "../net/frame_policy";
import type { CommandAction } from "../../client/session/events";
import { byId } from "../ui/dom";
import { describeState } from "../ui/hud";
import { showNotice } from "../ui/notice";
import type { App } from "./app";
import { kTexts } from "../ui/texts";

/** Frames are told at most so often. */
const kTellEveryMs = 250;

export function openEmbeddedPage(app: App): void {
  const parameters = new URLSearchParams(location.search);
  const panel = parameters.get("panel");
  if (!document.body.classList.contains("panel-closed")) byId("panel-toggle").click();
  app.display.resize();
  const tool = parameters.get("tool");
  if (tool !== null) app.tools.begin(tool);
  leaveWheelToParent();
  const news = new News(app);
  if (panel !== "all") window.setInterval(() => showFailure(app), kTellEveryMs);
  if (window.parent === window) return;
  askParents(location.href).then(
    (parents) => connectParent(app, parents, news),
    (error: unknown) => app.warn(kTexts.parentCannotAct(error instanceof Error ? error.message : String(error))),
  );
}

function connectParent(app: App, parents: readonly string[], news: News): void {
  const { parent } = window;
  const link = new ParentLink(parents, {
    post: (message, origin) => parent.postMessage(message, origin),
    send: (request) => {
      const action = actionOf(app, request);
      return typeof action === "string" ? action : app.commands.send(action, kTexts.commands.request(request.kind));
    },
    warn: (text) => console.warn(`spindrift: ${text}`),
    nowMs: () => performance.now(),
  });
  app.answerListeners.push({
    ack: (commandId) => link.acked(commandId, app.lastAck?.appliedTick ?? 0),
    reject: (commandId, message, reason) => link.rejected(commandId, message || reason),
  });
  window.addEventListener("message", ({ source, origin, data }) => {
    if (!link.take({ isParent: source === parent, origin, data })) return;
    link.tell({ kind: "ready" });
    news.begin();
    tell();
  });
  const tell = (): void => {
    for (const message of news.take()) link.tell(message);
  };
  window.setInterval(tell, kTellEveryMs);
}

/** Returns the command of a request, or why it is refused. */
function actionOf({ effects }: App, request: Request): CommandAction | string {
  switch (request.kind) {
    case "splash": {
      const { xM, zM } = request;
      const usual = effects.splashAt({ xM, zM });
      if (usual?.case !== "splash") return kTexts.noEffects;
      const { radiusM: usualRadiusM = 1, depthM: usualDepthM = 1 } = usual.value;
      const radiusM = request.radiusM ?? usualRadiusM;
      // A smaller splash is as steep, a larger one no deeper.
      const depthM = request.depthM ?? usualDepthM * Math.min(radiusM / usualRadiusM, 1);
      return { case: "splash", value: { xM, zM, radiusM, depthM } };
    }
    case "wave": {
      const { kind: _, ...size } = request;
      const usual = effects.breakingWave();
      if (usual?.case !== "breakingWave") return kTexts.noEffects;
      return { case: "breakingWave", value: { ...usual.value, ...size, ...(size.directionDeg === undefined ? {} : { side: Side.DIRECTION }) } };
    }
    case "pause":
      return { case: "setPaused", value: { paused: request.paused } };
    case "step":
      return { case: "step", value: { tickCount: request.ticks } };
    case "set":
      return { case: "setParameter", value: { path: request.path, value: request.value } };
  }
}

/** What has changed since it was told last. */
class News {
  private told: Partial<Record<"room" | "frame" | "people", string>> = {};

  constructor(private readonly app: App) {}

  /** Tells all again: the parent is another one. */
  begin(): void {
    this.told = {};
  }

  take(): FrameMessage[] {
    const { state, entered, simTimeS, simTick, role, lessons } = this.app;
    const isConnected = state.name === "live" && entered !== undefined;
    const room: FrameMessage | undefined = isConnected
      ? { kind: "connected", room: clipped(entered.room), scene: clipped(entered.sceneName), title: clipped(entered.title), role }
      : state.name === "retrying" || state.name === "refused" ? { kind: "disconnected", why: state.name === "retrying" ? clipped(state.why) : clipped(state.reason) } : undefined;
    return [
      ...this.changed("room", room),
      ...this.changed("frame", isConnected && simTick > 0 ? { kind: "frame", timeS: simTimeS, tick: simTick } : undefined),
      ...this.changed("people", isConnected ? { kind: "people", count: lessons.people.length } : undefined),
    ];
  }

  private changed(name: keyof News["told"], message: FrameMessage | undefined): FrameMessage[] {
    const now = JSON.stringify(message);
    if (!message || this.told[name] === now) return [];
    this.told[name] = now;
    return [message];
  }
}

/** Says over the water that there is no connection: the card, which does elsewhere, is hidden. */
function showFailure({ state }: App): void {
  showNotice(state.name === "retrying" || state.name === "refused" ? kTexts.noConnection(describeState(state)) : "");
}

/** The wheel moves the page around, until somebody has clicked into the water; with Ctrl it zooms at once. */
function leaveWheelToParent(): void {
  window.addEventListener("wheel", (event) => {
    if (!document.hasFocus() && !event.ctrlKey) event.stopPropagation();
  }, { capture: true, passive: true });
}
