// Connects a program with a room.
import { readerFault } from "../codec/frame_reader";
import { findMissingRoom } from "../session/missing_room";
import type { ConnectionWorld, SocketLike } from "../session/world";
import { parseAddress } from "./address";
import { SpindriftError } from "./errors";
import { Water } from "./water";

/** Version of the program; the build defines it. */
declare const __PROGRAM_VERSION__: string;

/** A class like WebSocket of browsers. */
export type WebSocketClass = new (url: string, subprotocol: string) => unknown;

export interface ConnectOptions {
  /** The server's first room if left out, or that of the address. */
  room?: string;
  /** Shown to the others in the room. */
  name?: string;
  /** Gives a role; a guest's without one. */
  token?: string;
  /** Of an earlier Water: comes back as the same person. */
  resumeKey?: string;
  /** Name of the program, for the server's log. */
  client?: string;
  /** The first connection is tried for so long. 10 if left out. */
  patienceS?: number;
  /** Commands are answered within so long, but for those that build water. 10 if left out. */
  answerWithinS?: number;
  /** In Node `ws` if left out, elsewhere the runtime's own. */
  WebSocket?: WebSocketClass;
}

/** Connects with a room. `url`: "host:port", the address of the page (with its room and token), or a ws address. Rejects with Refused,
 *  ConnectionLost, or TypeError for an invalid address. */
export async function connect(url: string | URL, options: ConnectOptions = {}): Promise<Water> {
  const { room, name = "", resumeKey = "", client = `spindrift-javascript ${__PROGRAM_VERSION__}`, patienceS = 10, answerWithinS = 10 } = options;
  const Socket = options.WebSocket ?? globalThis.WebSocket;
  if (!Socket) throw new SpindriftError("this runtime has no WebSocket: pass one as options.WebSocket");
  for (const [what, value] of Object.entries({ patienceS, answerWithinS })) if (!(value > 0 && value <= 86_400)) throw new RangeError(`${what} ${value}: expected more than 0 and at most 86400 s`);
  const fault = readerFault();
  if (fault) throw new SpindriftError(fault);
  const { socket: socketUrl, token } = parseAddress(String(url), room, options.token);
  return new Water({ socketUrl, name, token, resumeKey, client, answerWithinS }, worldOf(Socket)).open(patienceS);
}

function worldOf(Socket: WebSocketClass): ConnectionWorld {
  return {
    openSocket: (url, subprotocol) => new Socket(url, subprotocol) as SocketLike,
    findMissingRoom: (socketUrl, token) => findMissingRoom(socketUrl, token, (url, init) => fetch(url, init)),
    nowMs: () => performance.timeOrigin + performance.now(),
    random: () => Math.random(),
    setTimer: (callback, ms) => setTimeout(callback, ms),
    clearTimer: (timer) => clearTimeout(timer as number),
  };
}
