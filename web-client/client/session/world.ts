// What a connection uses of its surroundings, so that tests need no network.
import type { PlainFrame } from "../codec/frame_types";
import type { HullForcesInfo } from "../codec/hulls";
import type { QueryAnswerInfo } from "../codec/query";
import type { ConnectionEvent } from "./events";
import type { MissingRoom } from "./missing_room";

/** The part of WebSocket that is used. */
export interface SocketLike {
  binaryType: string;
  readonly bufferedAmount: number;
  onopen: ((event: never) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  onerror: ((event: { message?: string }) => void) | null;
  send(bytes: Uint8Array<ArrayBuffer>): void;
  close(code?: number, reason?: string): void;
}

/** A number in browsers, an object in Node. */
export type Timer = number | object;

export interface ConnectionWorld {
  openSocket(url: string, subprotocol: string): SocketLike;
  /** Resolves to the room of a socket that did not open, if it does not exist. Does not reject. */
  findMissingRoom(socketUrl: string, token: string): Promise<MissingRoom | undefined>;
  /** Opens the room of such a socket. Resolves to undefined when the room exists, otherwise to the reason. Absent: a room that does not exist stays closed. Does not reject. */
  openRoom?(socketUrl: string, token: string): Promise<string | undefined>;
  /** Unix time of a clock that does not jump. */
  nowMs(): number;
  /** In [0, 1). */
  random(): number;
  setTimer(callback: () => void, ms: number): Timer;
  clearTimer(timer: Timer): void;
}

export interface ConnectionSink<E = ConnectionEvent> {
  event(event: E): void;
  /** The payload is valid until the call returns. */
  frame(frame: PlainFrame): void;
  /** Absent: nobody asks queries. */
  queryAnswer?(answer: QueryAnswerInfo): void;
  /** Absent: nobody moves boats. */
  hullForces?(forces: HullForcesInfo): void;
}
