// The connection that is made while the page loads: what it sends waits for the page.
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import type { PageEvent, PageEventHandlers, WorkerRequest } from "../src/net/messages";
import { abandonWorker, openWaterClient, prepareConnection, prepareWorker } from "../src/net/water_client";

class FakeWorker {
  static made: FakeWorker[] = [];
  readonly posted: WorkerRequest[] = [];
  isEnded = false;
  onmessage: (event: { data: unknown }) => void = () => {};
  constructor() {
    FakeWorker.made.push(this);
  }
  postMessage(request: WorkerRequest): void {
    this.posted.push(request);
  }
  terminate(): void {
    this.isEnded = true;
  }
  send(...events: unknown[]): void {
    for (const data of events) this.onmessage({ data });
  }
}

const kUrl = "ws://host/ws";
const kIdentity = { name: "Ada", token: "", resumeKey: "key" };
const frame = (layer: string, tick: number) => ({ kind: "frame", frame: { layer, tick, buffer: new ArrayBuffer(8) } });

function prepare(): void {
  prepareWorker();
  prepareConnection({ url: kUrl, identity: kIdentity });
}

function client() {
  const taken: PageEvent[] = [];
  const handlers = new Proxy({}, { get: () => (event: PageEvent) => void taken.push(event) }) as PageEventHandlers;
  return { taken, client: openWaterClient(handlers) };
}

describe("the early connection", () => {
  beforeEach(() => {
    FakeWorker.made = [];
    vi.stubGlobal("Worker", FakeWorker);
    vi.stubGlobal("document", { documentElement: { lang: "en" } });
  });
  afterEach(() => vi.unstubAllGlobals());

  it("starts at once, and once", () => {
    prepare();
    const [worker] = FakeWorker.made;
    expect(worker!.posted).toMatchObject([{ kind: "start", url: kUrl, identity: kIdentity, language: "en" }, { kind: "want", wishes: { frameRateHz: 10 } }]);
    client().client.start(kUrl, kIdentity);
    expect(worker!.posted).toHaveLength(2);
    expect(FakeWorker.made).toHaveLength(1);
  });

  it("starts with the page where nothing was connected before", () => {
    prepareWorker();
    expect(FakeWorker.made[0]!.posted).toEqual([]);
    client().client.start(kUrl, kIdentity);
    expect(FakeWorker.made).toHaveLength(1);
    expect(FakeWorker.made[0]!.posted).toMatchObject([{ kind: "start", url: kUrl }]);
  });

  it("hands on in order what came before the page, and then what comes", () => {
    prepare();
    const [worker] = FakeWorker.made;
    worker!.send({ kind: "greeting" }, { kind: "welcome" }, frame("surface", 1));
    const rig = client();
    worker!.send({ kind: "people" });
    expect(rig.taken).toEqual([]);
    rig.client.start(kUrl, kIdentity);
    worker!.send(frame("surface", 2));
    expect(rig.taken.map(({ kind }) => kind)).toEqual(["greeting", "welcome", "frame", "people", "frame"]);
  });

  it("keeps the newest frame of each layer and returns the others, so that nothing piles up", () => {
    prepare();
    const [worker] = FakeWorker.made;
    for (let tick = 1; tick <= 100; ++tick) worker!.send(frame("surface", tick), frame("foam", tick));
    expect(worker!.posted.filter(({ kind }) => kind === "release")).toHaveLength(198);
    const rig = client();
    rig.client.start(kUrl, kIdentity);
    expect(rig.taken).toMatchObject([{ frame: { layer: "surface", tick: 100 } }, { frame: { layer: "foam", tick: 100 } }]);
  });

  it("is not taken for another room, nor by a second client", () => {
    prepare();
    client().client.start("ws://host/ws/other", kIdentity);
    expect(FakeWorker.made[0]!.posted.filter(({ kind }) => kind === "start")).toMatchObject([{ url: kUrl }, { url: "ws://host/ws/other" }]);
    client().client.start(kUrl, kIdentity);
    expect(FakeWorker.made[1]!.posted).toMatchObject([{ kind: "start", url: kUrl }]);
  });

  it("ends where no water is drawn, and where no page takes what it sends", () => {
    prepare();
    abandonWorker();
    prepare();
    const [abandoned, ignored] = FakeWorker.made;
    for (let k = 0; k < 1000; ++k) ignored!.send({ kind: "people" });
    expect([abandoned!.isEnded, ignored!.isEnded]).toEqual([true, false]);
    ignored!.send({ kind: "people" });
    expect(ignored!.isEnded).toBe(true);
    client().client.start(kUrl, kIdentity);
    expect(FakeWorker.made[2]!.posted).toMatchObject([{ kind: "start", url: kUrl }]);
  });
});
