// The page's end of the worker: typed events in, calls and commands out. Gives out the command ids.
import type { GroundGrid } from "../../client/codec/ground";
import type { CommandAction, Identity } from "../../client/session/events";
import type { Frame, GroundAnswer, PageEvent, PageEventHandlers, PageWishes, SessionCalls, WorkerRequest } from "./messages";
import type { RoomWish } from "../../client/rest/rooms";
import { roomOf } from "./room_address";

type StartRequest = Extract<WorkerRequest, { kind: "start" }>;

/** A worker without a client, and what it has sent: of the frames of a layer the newest alone. */
interface Prepared {
  worker: Worker;
  /** Undefined: it does not connect yet. */
  url: string | undefined;
  waiting: PageEvent[];
}
let prepared: Prepared | undefined;
/** Frames per second of each layer until the page is there. */
const kWaitingRateHz = 10;
/** Events that wait for the page at most: more come only where none will be. */
const kMostWaiting = 1000;

/** Starts the worker while the page loads. */
export function prepareWorker(): void {
  const waiting: PageEvent[] = [];
  const worker = newWorker();
  worker.onmessage = ({ data: event }: MessageEvent<PageEvent>) => {
    const older = event.kind === "frame" ? waiting.findIndex((other) => other.kind === "frame" && other.frame.layer === event.frame.layer) : -1;
    const [superseded] = older >= 0 ? waiting.splice(older, 1) : [];
    if (superseded?.kind === "frame") release(worker, superseded.frame);
    if (waiting.push(event) > kMostWaiting) abandonWorker();
  };
  prepared = { worker, url: undefined, waiting };
}

/** Starts the connection of the prepared worker while the page makes its WebGL context: in software that takes as long. */
export function prepareConnection(start: StartParameters): void {
  if (!prepared) return;
  prepared.url = start.url;
  const { worker } = prepared;
  worker.postMessage(startRequest(start));
  // What nobody draws yet: the page asks for as many as its quality needs.
  worker.postMessage({ kind: "want", wishes: { frameRateHz: kWaitingRateHz } } satisfies WorkerRequest);
}

/** Ends the prepared worker and its connection, for a page that draws no water. */
export function abandonWorker(): void {
  prepared?.worker.terminate();
  prepared = undefined;
}

/** Returns a frame's buffer to its worker. */
function release(worker: Worker, { layer, buffer }: Frame): void {
  worker.postMessage({ kind: "release", layer, buffer } satisfies WorkerRequest, [buffer]);
}

/** `wish`: opens the room if it does not exist. */
interface StartParameters {
  url: string;
  identity: Identity;
  wish?: RoomWish | undefined;
}

function startRequest({ url, identity, wish }: StartParameters): StartRequest {
  return { kind: "start", url, identity, wish, language: document.documentElement.lang };
}

function newWorker(): Worker {
  return new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
}

/** Each client has a worker of its own: the front page has one per room. */
export function openWaterClient(handlers: PageEventHandlers): WaterClient {
  const own = prepared ?? { worker: newWorker(), url: undefined, waiting: [] };
  prepared = undefined;
  return new WaterClient(own, handlers);
}

export class WaterClient {
  private nextCommandId = 1;
  private nextGroundId = 1;
  private readonly groundAnswers = new Map<number, (answer: GroundAnswer) => void>();

  private readonly worker: Worker;

  constructor(
    private readonly prepared: Prepared,
    private readonly handlers: PageEventHandlers,
  ) {
    this.worker = prepared.worker;
  }

  /** Connects, and hands on what a connection that was prepared has received. `wish`: opens the room if it does not exist. */
  start(url: string, identity: Identity, wish?: RoomWish): void {
    const { waiting } = this.prepared;
    this.worker.onmessage = ({ data }: MessageEvent<PageEvent | GroundAnswer>) => this.handle(data);
    if (this.prepared.url !== url) return this.post(startRequest({ url, identity, wish }));
    for (const event of waiting.splice(0)) this.handle(event);
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
  release(frame: Frame): void {
    release(this.worker, frame);
  }

  /** Ends the worker, and with it the connection. */
  close(): void {
    this.worker.terminate();
  }

  private handle(event: PageEvent | GroundAnswer): void {
    if (event.kind !== "ground") return (this.handlers[event.kind] as (event: PageEvent) => void)(event);
    this.groundAnswers.get(event.requestId)?.(event);
    this.groundAnswers.delete(event.requestId);
  }

  private post(request: WorkerRequest): void {
    this.worker.postMessage(request);
  }
}

/** Returns the address of the socket beside the page: ws, or ws/ROOM for the room of the page's address; wss for an https page. */
export function socketUrl(page: string): string {
  const room = roomOf(new URL(page).search);
  const url = new URL(room ? `ws/${encodeURIComponent(room)}` : "ws", page);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  return url.href;
}
