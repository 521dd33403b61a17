// <spindrift-water>: shows the water of a room of a Spindrift server in any page. It needs no build step: the server has it at /element.js.
import { frameAddress, kPageAttributes, type PageAttribute } from "./address.js";
import { envelope, isOurs, readFrameMessage, type FrameEvents, type FrameMessage, type ParentMessage, type Request, type SplashOptions, type WaveOptions } from "./protocol.js";

export type { FrameEvents, Role, SplashOptions, WaveOptions } from "./protocol.js";

/** Requests without an answer; further ones are refused. */
const kWaitingMaxCount = 256;

/** The events of the element; `detail` has their data. */
export type WaterEventMap = { [K in keyof FrameEvents]: CustomEvent<FrameEvents[K]> };

interface Waiting {
  done(answer: { tick: number }): void;
  refused(error: Error): void;
}

/**
 * Attributes: `server` (address of the server's page; by default that of the server this script came from), `room`, `scene`, `view`, `camera`,
 * `light`, `look`, `quality`, `tool`, `panel` (`tools`, `all`; by default none) and `token`. A changed attribute loads the frame again.
 *
 * The methods ask for what the visitor could do by hand. Each returns a promise: it is resolved with the tick at which the room carried the
 * request out, and rejected with the reason of a refusal.
 */
export class SpindriftWater extends HTMLElement {
  static readonly observedAttributes: readonly string[] = ["server", "token", ...kPageAttributes];

  private readonly frame = document.createElement("iframe");
  private readonly waiting = new Map<number, Waiting>();
  private address: URL | undefined;
  private isReady = false;
  private isStale = false;
  private lastId = 0;

  constructor() {
    super();
    const style = new CSSStyleSheet();
    style.replaceSync(":host { display: block; aspect-ratio: 16 / 9; background: #0a2233; } :host([hidden]) { display: none; } iframe { display: block; width: 100%; height: 100%; border: 0; }");
    const root = this.attachShadow({ mode: "open" });
    root.adoptedStyleSheets = [style];
    root.append(this.frame);
  }

  connectedCallback(): void {
    window.addEventListener("message", this.take);
    this.load();
  }

  disconnectedCallback(): void {
    window.removeEventListener("message", this.take);
    this.close("the element was removed from the page");
    this.address = undefined;
  }

  /** Attributes that change together load the frame once. */
  attributeChangedCallback(_name: string, before: string | null, now: string | null): void {
    if (before === now || !this.address || this.isStale) return;
    this.isStale = true;
    queueMicrotask(() => {
      this.isStale = false;
      if (this.isConnected) this.load();
    });
  }

  splash(options: SplashOptions): Promise<{ tick: number }> {
    return this.ask({ kind: "splash", ...options });
  }

  wave(options: WaveOptions = {}): Promise<{ tick: number }> {
    return this.ask({ kind: "wave", ...options });
  }

  /** For operators, as the next two. */
  pause(paused = true): Promise<{ tick: number }> {
    return this.ask({ kind: "pause", paused });
  }

  /** In a paused room. */
  step(ticks = 1): Promise<{ tick: number }> {
    return this.ask({ kind: "step", ticks });
  }

  /** Sets a parameter of the scene by its path, such as "wave.depth_m". */
  set(path: string, value: number): Promise<{ tick: number }> {
    return this.ask({ kind: "set", path, value });
  }

  override addEventListener<K extends keyof WaterEventMap>(type: K, listener: (this: SpindriftWater, event: WaterEventMap[K]) => unknown, options?: boolean | AddEventListenerOptions): void;
  override addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
  override addEventListener(type: string, listener: unknown, options?: boolean | AddEventListenerOptions): void {
    super.addEventListener(type, listener as EventListener, options);
  }

  private load(): void {
    this.close("the frame was loaded again");
    const values: Partial<Record<PageAttribute, string>> = {};
    for (const name of kPageAttributes) {
      const value = this.getAttribute(name);
      if (value !== null) values[name] = value;
    }
    try {
      this.address = frameAddress(this.getAttribute("server") ?? new URL(/* @vite-ignore */ ".", import.meta.url).href, values, this.getAttribute("token") ?? "");
    } catch (error) {
      this.tell("error", { message: error instanceof Error ? error.message : String(error) });
      return;
    }
    this.frame.title = `Water of the room ${values.room ?? "main"}`;
    this.frame.src = this.address.href;
  }

  private close(why: string): void {
    this.isReady = false;
    for (const { refused } of this.waiting.values()) refused(new Error(why));
    this.waiting.clear();
  }

  private ask(request: Request): Promise<{ tick: number }> {
    if (!this.isReady) return Promise.reject(new Error('the water is not ready: wait for the event "ready"'));
    if (this.waiting.size >= kWaitingMaxCount) return Promise.reject(new Error(`${kWaitingMaxCount} requests wait for an answer`));
    const id = ++this.lastId;
    return new Promise((done, refused) => {
      this.waiting.set(id, { done, refused });
      this.post({ ...request, id });
    });
  }

  /** The browser delivers it only while the frame shows a page of this server. */
  private post(message: ParentMessage): void {
    this.frame.contentWindow?.postMessage(envelope(message), this.address!.origin);
  }

  private readonly take = ({ source, origin, data }: MessageEvent<unknown>): void => {
    if (source === null || source !== this.frame.contentWindow || origin !== this.address?.origin || !isOurs(data)) return;
    const message = readFrameMessage(data);
    if (typeof message === "string") console.warn(`spindrift-water: a message of the frame was ignored: ${message}`);
    else this.handle(message);
  };

  private handle(message: FrameMessage): void {
    switch (message.kind) {
      case "loaded":
        this.close("the frame was loaded again");
        return this.post({ kind: "hello" });
      case "done":
        return this.answered(message.id, ({ done }) => done({ tick: message.tick }));
      case "refused":
        return this.answered(message.id, ({ refused }) => refused(new Error(message.reason)));
      default: {
        const { kind, ...detail } = message;
        if (kind === "ready") this.isReady = true;
        this.tell(kind, detail);
      }
    }
  }

  private answered(id: number, settle: (waiting: Waiting) => void): void {
    const waiting = this.waiting.get(id);
    this.waiting.delete(id);
    if (waiting) settle(waiting);
  }

  private tell(kind: keyof FrameEvents, detail: object): void {
    this.dispatchEvent(new CustomEvent(kind, { detail }));
  }
}

// Another script of the same page may have defined it.
if (!customElements.get("spindrift-water")) customElements.define("spindrift-water", SpindriftWater);

declare global {
  interface HTMLElementTagNameMap {
    "spindrift-water": SpindriftWater;
  }
}
