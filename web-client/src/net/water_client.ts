// The page's end of the worker: typed events in, commands out. Gives command ids and owns the worker.
import type { CommandAction, DetailChoice, Frame, FrameLayer, Identity, PageToWorker, WorkerToPage } from "./messages";

/** The part of Worker that is used. */
export interface WorkerLike {
  onmessage: ((event: { data: WorkerToPage }) => void) | null;
  postMessage(message: PageToWorker, transfer: Transferable[]): void;
  terminate(): void;
}

export type WaterEvents = {
  [K in WorkerToPage["type"]]: (message: Extract<WorkerToPage, { type: K }>) => void;
};

export class WaterClient {
  private nextCommandId = 1;

  constructor(
    private readonly worker: WorkerLike,
    events: WaterEvents,
  ) {
    worker.onmessage = ({ data }) => (events[data.type] as (message: WorkerToPage) => void)(data);
  }

  start(url: string, identity: Identity): void {
    this.worker.postMessage({ type: "start", url, identity }, []);
  }

  /** Connects anew under this name and token. */
  introduce(name: string, token: string): void {
    this.worker.postMessage({ type: "introduce", name, token }, []);
  }

  /** Sends and returns the id that its ack or reject will carry. */
  command(action: CommandAction): number {
    const commandId = this.nextCommandId++;
    this.worker.postMessage({ type: "command", commandId, action }, []);
    return commandId;
  }

  /** Gives a frame's buffer back; the frame must not be read afterwards. */
  release(frame: Frame): void {
    this.releaseBuffer(frame.layer, frame.buffer);
  }

  /** How much of the layers to ask for. */
  setDetail(detail: DetailChoice): void {
    this.worker.postMessage({ type: "detail", detail }, []);
  }

  setVisible(visible: boolean): void {
    this.worker.postMessage({ type: "visible", visible }, []);
  }

  retryNow(): void {
    this.worker.postMessage({ type: "retry" }, []);
  }

  dispose(): void {
    this.worker.terminate();
  }

  private releaseBuffer(layer: FrameLayer, buffer: ArrayBuffer): void {
    this.worker.postMessage({ type: "release", layer, buffer }, [buffer]);
  }
}

/** ws://HOST/ws, or /ws/ROOM for the page's ?room=ROOM; wss from an https page. */
export function socketUrl(location: { protocol: string; host: string; search: string }): string {
  const room = new URLSearchParams(location.search).get("room");
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  return `${scheme}//${location.host}/ws${room ? `/${encodeURIComponent(room)}` : ""}`;
}
