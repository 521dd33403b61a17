// The page's end of the messages with the page around it (element/protocol.ts): takes requests from that page alone, as many as a busy hand
// could make, and answers each once.
import { clipped, envelope, isOurs, readParentMessage, type FrameMessage, type Request } from "../../element/protocol";

/** More than any hand does, and below the server's own limit of commands per session. */
const kRequestsPerS = 60;
const kBurstCount = 120;
const kWarningEveryMs = 1000;

interface LinkHost {
  /** Sends to the parent window, if it is of this origin. */
  post(message: object, origin: string): void;
  /** Sends what is asked for to the server, as the visitor's own command; returns its id, or why it cannot be sent. */
  send(request: Request): number | string;
  warn(text: string): void;
  nowMs(): number;
}

export class ParentLink {
  /** Origin of the parent; undefined until its hello. */
  private parent: string | undefined;
  /** Ids of requests by those of their commands. */
  private readonly requests = new Map<number, number>();
  private tokens = kBurstCount;
  private filledMs: number;
  private warnedMs = -Infinity;

  /** `allowed`: origins that the server lets embed this page. */
  constructor(
    private readonly allowed: readonly string[],
    private readonly host: LinkHost,
  ) {
    this.filledMs = host.nowMs();
    // Any parent may know that there is a page.
    host.post(envelope({ kind: "loaded" }), "*");
  }

  /** Takes a message of a window; returns true for the parent's hello. */
  take({ isParent, origin, data }: { isParent: boolean; origin: string; data: unknown }): boolean {
    if (!isOurs(data)) return false;
    if (!isParent || !this.allowed.includes(origin)) {
      this.warn(`a message from ${clipped(origin)} was ignored: it is not the page around this one, or not in the server's --embed`);
      return false;
    }
    const message = readParentMessage(data);
    if (typeof message === "string") {
      this.warn(`a message was ignored: ${message}`);
      return false;
    }
    this.parent = origin;
    if (message.kind === "hello") return true;
    this.answer(message);
    return false;
  }

  tell(message: FrameMessage): void {
    if (this.parent !== undefined) this.host.post(envelope(message), this.parent);
  }

  acked(commandId: number, tick: number): void {
    this.answered(commandId, (id) => ({ kind: "done", id, tick }));
  }

  rejected(commandId: number, reason: string): void {
    this.answered(commandId, (id) => ({ kind: "refused", id, reason: clipped(reason) }));
  }

  private answer({ id, ...request }: Request & { id: number }): void {
    const commandId = this.isTooFast() ? `more than ${kRequestsPerS} requests per second` : this.host.send(request as Request);
    if (typeof commandId === "string") this.tell({ kind: "refused", id, reason: clipped(commandId) });
    else this.requests.set(commandId, id);
  }

  private answered(commandId: number, answer: (id: number) => FrameMessage): void {
    const id = this.requests.get(commandId);
    if (id === undefined) return;
    this.requests.delete(commandId);
    this.tell(answer(id));
  }

  private isTooFast(): boolean {
    const nowMs = this.host.nowMs();
    this.tokens = Math.min(kBurstCount, this.tokens + ((nowMs - this.filledMs) / 1000) * kRequestsPerS);
    this.filledMs = nowMs;
    if (this.tokens < 1) return true;
    this.tokens -= 1;
    return false;
  }

  private warn(text: string): void {
    const nowMs = this.host.nowMs();
    if (nowMs - this.warnedMs < kWarningEveryMs) return;
    this.warnedMs = nowMs;
    this.host.warn(text);
    this.tell({ kind: "error", message: clipped(text) });
  }
}
