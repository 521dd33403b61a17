// The worker's root: a Connection on one side, postMessage on the other. Payloads are copied once, out of the message
// into an aligned buffer, and travel to the page and back by transfer.
import { readerFault } from "../codec/frame_reader";
import { Connection, type ConnectionWorld, type SocketLike } from "./connection";
import { FrameHandover } from "./handover";
import type { DetailChoice, Frame, FrameLayer, Identity, PageToWorker, WorkerToPage } from "./messages";

/** The page's ring holds four; one more may be on its way. */
const kMaxFramesUnderWay = 5;

function toPage(message: WorkerToPage, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

function handover(isGrowing: boolean): FrameHandover<Frame> {
  return new FrameHandover<Frame>((frame) => toPage({ type: "frame", frame }, [frame.buffer]), kMaxFramesUnderWay, isGrowing);
}

// Particles come and go in scenes where only broken water is particles, and so do boats.
const handovers: Record<FrameLayer, FrameHandover<Frame>> = {
  surface: handover(false),
  particles: handover(true),
  foam: handover(false),
  bodies: handover(true),
};

function copyInto(buffer: ArrayBuffer, payload: Uint8Array): ArrayBuffer {
  new Uint8Array(buffer).set(payload);
  return buffer;
}

const world: ConnectionWorld = {
  openSocket: (url, subprotocol) => new WebSocket(url, subprotocol) as unknown as SocketLike,
  // Unix time, which the page can convert to its own; it does not jump as Date.now() may.
  nowMs: () => performance.timeOrigin + performance.now(),
  random: () => Math.random(),
  setTimer: (callback, ms) => self.setTimeout(callback, ms),
  clearTimer: (timer) => self.clearTimeout(timer),
};

let connection: Connection | undefined;
let detail: DetailChoice = "auto";

function start(url: string, identity: Identity): void {
  connection?.stop();
  const fault = readerFault();
  if (fault) return toPage({ type: "state", state: { name: "refused", reason: fault } });
  connection = new Connection(url, world, {
    state: (state) => toPage({ type: "state", state }),
    greeting: (greeting) => {
      for (const layer of Object.values(handovers)) layer.forgetSpares();
      toPage({ type: "greeting", greeting });
    },
    frame: ({ kind, header, payload }) => {
      const buffer = copyInto(handovers[kind].takeBuffer(payload.length), payload);
      handovers[kind].offer({ layer: kind, ...header, buffer } as Frame);
    },
    diagnostics: (diagnostics) => toPage({ type: "diagnostics", diagnostics }),
    ack: (commandId, appliedTick, boatId) => toPage({ type: "ack", commandId, appliedTick, boatId }),
    reject: (commandId, reason, field, message) => toPage({ type: "reject", commandId, reason, field, message }),
    parameterChanged: (path, value) => toPage({ type: "parameterChanged", path, value }),
    roomState: (paused, speed) => toPage({ type: "roomState", paused, speed }),
    welcome: (welcome) => toPage({ type: "welcome", welcome }),
    people: (people) => toPage({ type: "people", people }),
    boatList: (boats) => toPage({ type: "boatList", boats }),
    roomEvent: (event, message) => toPage({ type: "roomEvent", event, message }),
    clock: (leadMs) => toPage({ type: "clock", leadS: leadMs / 1000 }),
    stats: (stats) => {
      const overtakenCount = Object.values(handovers).reduce((sum, layer) => sum + layer.overtakenCount, 0);
      toPage({ type: "stats", stats: { ...stats, overtakenCount } });
    },
  }, identity);
  connection.setDetail(detail);
  connection.start();
}

self.addEventListener("message", (event: MessageEvent<PageToWorker>) => {
  const message = event.data;
  switch (message.type) {
    case "start":
      return start(message.url, message.identity);
    case "introduce":
      return connection?.introduce(message.name, message.token);
    case "command":
      return connection?.command(message.commandId, message.action);
    case "release":
      return handovers[message.layer].release(message.buffer);
    case "detail":
      detail = message.detail;
      return connection?.setDetail(detail);
    case "visible":
      return connection?.setVisible(message.visible);
    case "retry":
      return connection?.retryNow();
  }
});
