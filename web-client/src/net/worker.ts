// The worker's root: passes calls on to the connection, and events and frames back to the page. A payload is copied once, out of the
// message into an aligned buffer, which travels to the page and back by transfer.
import { readerFault } from "../../client/codec/frame_reader";
import type { FrameLayer } from "../../client/codec/layers";
import { requestGround } from "../../client/rest/ground";
import type { RoomWish } from "../../client/rest/rooms";
import type { Identity } from "../../client/session/events";
import { findMissingRoom } from "../../client/session/missing_room";
import type { ConnectionWorld, SocketLike } from "../../client/session/world";
import { FrameHandover } from "./handover";
import type { Frame, GroundAnswer, PageConnectionEvent, PageEvent, WorkerRequest } from "./messages";
import { kNetTexts } from "./net_texts";
import { openRoom } from "./open_room";
import { PageConnection } from "./page_connection";

/** The page's ring holds five; one more may be on its way. */
const kMaxFramesUnderWay = 6;

function post(event: PageEvent | GroundAnswer, transfer: Transferable[] = []): void {
  self.postMessage(event, { transfer });
}

function makeHandover(isGrowing: boolean): FrameHandover<Frame> {
  return new FrameHandover<Frame>((frame) => post({ kind: "frame", frame }, [frame.buffer]), kMaxFramesUnderWay, isGrowing);
}

// The number of particles, boats and objects changes from frame to frame, the size of a plane does not.
const handovers: Record<FrameLayer, FrameHandover<Frame>> = {
  surface: makeHandover(false),
  particles: makeHandover(true),
  foam: makeHandover(false),
  bodies: makeHandover(true),
  floaters: makeHandover(true),
};

const world: ConnectionWorld = {
  openSocket: (url, subprotocol) => new WebSocket(url, subprotocol) as unknown as SocketLike,
  findMissingRoom: (socketUrl, token) => findMissingRoom(socketUrl, token, (url, init) => self.fetch(url, init)),
  // Unlike Date.now() it does not jump.
  nowMs: () => performance.timeOrigin + performance.now(),
  random: () => Math.random(),
  setTimer: (callback, ms) => self.setTimeout(callback, ms),
  clearTimer: (timer) => self.clearTimeout(timer as number),
};

let connection: PageConnection | undefined;

function start(url: string, identity: Identity, wish: RoomWish | undefined): void {
  connection?.session.stop();
  const fault = readerFault();
  if (fault) return post({ kind: "state", state: { name: "refused", reason: fault, rooms: [] } });
  const wait = (ms: number): Promise<void> => new Promise((done) => self.setTimeout(done, ms));
  const withWish: ConnectionWorld = wish ? { ...world, openRoom: (socketUrl, token) => openRoom(socketUrl, token, wish, (address, init) => self.fetch(address, init), wait) } : world;
  connection = new PageConnection(url, withWish, {
    event: passOn,
    frame: ({ kind, header, payload }) => {
      const buffer = handovers[kind].takeBuffer(payload.length);
      new Uint8Array(buffer).set(payload);
      handovers[kind].offer({ layer: kind, ...header, buffer } as Frame);
    },
  }, identity);
  connection.session.start();
}

function passOn(event: PageConnectionEvent): void {
  if (event.kind === "stats") {
    const supersededCount = Object.values(handovers).reduce((sum, handover) => sum + handover.supersededCount, 0);
    return post({ ...event, supersededCount });
  }
  // Another room's buffers have other sizes.
  if (event.kind === "greeting") for (const handover of Object.values(handovers)) handover.forgetSpares();
  post(event);
}

function answerGround({ requestId, address, room, token }: Extract<WorkerRequest, { kind: "ground" }>): Promise<void> {
  return requestGround(address, room, token).then(
    (ground) => post({ kind: "ground", requestId, ground }, [ground.riseM.buffer]),
    (error: unknown) => post({ kind: "ground", requestId, why: error instanceof Error ? error.message : String(error) }),
  );
}

self.addEventListener("message", ({ data: request }: MessageEvent<WorkerRequest>) => {
  switch (request.kind) {
    case "start":
      // Calls follow at once, so nothing waits for it: a line before it is there is English.
      if (request.language === "de") void import("./net_texts_de").then(({ kGermanNetTexts }) => Object.assign(kNetTexts, kGermanNetTexts));
      return start(request.url, request.identity, request.wish);
    case "ground":
      return void answerGround(request);
    case "release":
      return handovers[request.layer].release(request.buffer);
    case "want":
      return connection?.want(request.wishes);
    case "call":
      return (connection?.session[request.name] as ((...args: unknown[]) => void) | undefined)?.apply(connection?.session, request.args);
  }
});
