// The worker's root: a Connection on one side, postMessage on the other. Payloads are copied once, out of the message
// into an aligned buffer, and travel to the page and back by transfer.
import { Connection, type ConnectionWorld, type SocketLike } from "./connection";
import { FrameHandover } from "./handover";
import type { PageToWorker, ParticleFrame, SurfaceFrame, WorkerToPage } from "./messages";

/** The page's ring holds four; one more may be on its way. */
const kMaxFramesUnderWay = 5;

function toPage(message: WorkerToPage, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

const surfaces = new FrameHandover<SurfaceFrame>((frame) => toPage({ type: "frame", frame }, [frame.buffer]), kMaxFramesUnderWay);
const particles = new FrameHandover<ParticleFrame>((frame) => toPage({ type: "frame", frame }, [frame.buffer]), kMaxFramesUnderWay);

function copyInto(buffer: ArrayBuffer, payload: Uint8Array): ArrayBuffer {
  new Uint8Array(buffer).set(payload);
  return buffer;
}

const world: ConnectionWorld = {
  openSocket: (url, subprotocol) => new WebSocket(url, subprotocol) as unknown as SocketLike,
  nowMs: () => performance.now(),
  random: () => Math.random(),
  setTimer: (callback, ms) => self.setTimeout(callback, ms),
  clearTimer: (timer) => self.clearTimeout(timer),
};

let connection: Connection | undefined;

function start(url: string): void {
  connection?.stop();
  connection = new Connection(url, world, {
    state: (state) => toPage({ type: "state", state }),
    greeting: (greeting) => toPage({ type: "greeting", greeting }),
    frame: (frame) => {
      if (frame.kind === "surface") {
        const buffer = copyInto(surfaces.takeBuffer(frame.payload.length), frame.payload);
        surfaces.offer({ layer: "surface", ...frame.header, buffer });
      } else {
        const buffer = copyInto(particles.takeBuffer(frame.payload.length), frame.payload);
        particles.offer({ layer: "particles", ...frame.header, buffer });
      }
    },
    diagnostics: (diagnostics) => toPage({ type: "diagnostics", diagnostics }),
    ack: (commandId, appliedTick) => toPage({ type: "ack", commandId, appliedTick }),
    reject: (commandId, reason, field, message) => toPage({ type: "reject", commandId, reason, field, message }),
    parameterChanged: (path, value) => toPage({ type: "parameterChanged", path, value }),
    roomState: (paused, speed) => toPage({ type: "roomState", paused, speed }),
    stats: (stats) =>
      toPage({ type: "stats", stats: { ...stats, overtakenCount: surfaces.overtakenCount + particles.overtakenCount } }),
  });
  connection.start();
}

self.addEventListener("message", (event: MessageEvent<PageToWorker>) => {
  const message = event.data;
  switch (message.type) {
    case "start":
      return start(message.url);
    case "command":
      return connection?.command(message.commandId, message.action);
    case "release":
      return (message.layer === "surface" ? surfaces : particles).release(message.buffer);
    case "visible":
      return connection?.setVisible(message.visible);
    case "retry":
      return connection?.retryNow();
  }
});
