// What a connection uses of the browser, so that tests need no network.
import type { PlainFrame } from "../codec/frame_types";
import type { ConnectionEvent } from "./messages";
import type { MissingRoom } from "./missing_room";

/** The part of WebSocket that is used. */
export interface SocketLike {
  binaryType: string;
  readonly bufferedAmount: number;
  onopen: ((event: never) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  onerror: ((event: never) => void) | null;
  send(bytes: Uint8Array<ArrayBuffer>): void;
  close(code?: number, reason?: string): void;
}

export interface ConnectionWorld {
  openSocket(url: string, subprotocol: string): SocketLike;
  /** Resolves to the room of a socket that did not open, if it does not exist. Does not reject. */
  findMissingRoom(socketUrl: string, token: string): Promise<MissingRoom | undefined>;
  /** Opens the room of such a socket. Resolves to undefined when the room exists, otherwise to the reason. Absent: the page's address has no scene. Does not reject. */
  openRoom?(socketUrl: string, token: string): Promise<string | undefined>;
  /** Unix time in the browser, so that the page can convert what is derived from it. */
  nowMs(): number;
  /** In [0, 1). */
  random(): number;
  setTimer(callback: () => void, ms: number): number;
  clearTimer(timer: number): void;
}

export interface ConnectionSink {
  event(event: ConnectionEvent): void;
  /** The payload is valid until the call returns. */
  frame(frame: PlainFrame): void;
}
