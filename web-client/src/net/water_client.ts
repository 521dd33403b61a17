// The page's end of the worker: typed events in, calls and commands out. Gives out the command ids.
import type { GroundGrid } from "../../client/codec/ground";
import type { CommandAction, Identity } from "../../client/session/events";
import type { Frame, GroundAnswer, PageEvent, PageEventHandlers, PageWishes, SessionCalls, WorkerRequest } from "./messages";
import type { RoomWish } from "../../client/rest/rooms";
import { roomOf } from "./room_address";

let prepared: Worker | undefined;

/** Starts the worker, so that it is loaded while the page makes its WebGL context: in software that takes as long. */
export function prepareWorker(): void {
  prepared ??= newWorker();
}

function newWorker(): Worker {
  return new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
}

/** Each client has a worker of its own: the front page has one per room. */
export function openWaterClient(handlers: PageEventHandlers): WaterClient {
  const worker = prepared ?? newWorker();
  prepared = undefined;
  return new WaterClient(worker, handlers);
}

export class WaterClient {
  private nextCommandId = 1;
  private nextGroundId = 1;
  private readonly groundAnswers = new Map<number, (answer: GroundAnswer) => void>();

  constructor(
    private readonly worker: Worker,
    handlers: PageEventHandlers,
  ) {
    worker.onmessage = ({ data }: MessageEvent<PageEvent | GroundAnswer>) => {
      if (data.kind !== "ground") return (handlers[data.kind] as (event: PageEvent) => void)(data);
      this.groundAnswers.get(data.requestId)?.(data);
      this.groundAnswers.delete(data.requestId);
    };
  }

  /** `wish`: opens the room if it does not exist. */
  start(url: string, identity: Identity, wish?: RoomWish): void {
    this.post({ kind: "start", url, identity, wish, language: document.documentElement.lang });
  }

  /** Changes what the page wants; what is left out stays. */
  want(wishes: Partial<PageWishes>): void {
    this.post({ kind: "want", wishes });
  }

  /** Calls a method of the session. */
  call<K extends keyof SessionCalls>(name: K, ...args: Parameters<SessionCalls[K]>): void {
    this.post({ kind: "call", name, args } as WorkerRequest);
  }

  /** Sends a command and returns the id that its ack or reject carries. */
  command(action: CommandAction): number {
    const commandId = this.nextCommandId++;
    this.call("command", commandId, action);
    return commandId;
  }

  /** Returns the ground of a room with a bed. Throws an Error with a line for people. */
  async requestGround(room: string, token: string): Promise<GroundGrid> {
    const requestId = this.nextGroundId++;
    const address = new URL(`api/v1/rooms/${encodeURIComponent(room)}/ground`, location.href).href;
    const answer = await new Promise<GroundAnswer>((resolve) => {
      this.groundAnswers.set(requestId, resolve);
      this.post({ kind: "ground", requestId, address, room, token });
    });
    if ("why" in answer) throw new Error(answer.why);
    return answer.ground;
  }

  /** Returns a frame's buffer to the worker; the frame must not be read afterwards. */
  release({ layer, buffer }: Frame): void {
    this.post({ kind: "release", layer, buffer }, [buffer]);
  }

  /** Ends the worker, and with it the connection. */
  close(): void {
    this.worker.terminate();
  }

  private post(request: WorkerRequest, transfer: Transferable[] = []): void {
    this.worker.postMessage(request, transfer);
  }
}

/** Returns the address of the socket beside the page: ws, or ws/ROOM for the room of the page's address; wss for an https page. */
export function socketUrl(page: string): string {
  const room = roomOf(new URL(page).search);
  const url = new URL(room ? `ws/${encodeURIComponent(room)}` : "ws", page);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  return url.href;
}
