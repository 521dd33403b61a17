// The front page: where the address leads, and which pictures are live.
import { describe, expect, it } from "vitest";

import { leadsToFront, type EntranceWorld } from "../src/front/entrance";
import { chooseLive, pictureWidthPercent, stateOf } from "../src/front/front_model";
import type { RoomSummary } from "../client/rest/rooms";

const room = (name: string, more: Partial<RoomSummary> = {}): RoomSummary => ({ name, scene: "pool", title: "Pool", isPaused: false, isAsleep: false, peopleCount: 0, ...more });

describe("the address", () => {
  /** A server with these rooms; without any it does not answer. */
  function world(names: string[]): EntranceWorld {
    const isGone = names.length === 0;
    return {
      requestRooms: () => (isGone ? Promise.reject(new Error("gone")) : Promise.resolve(names.map((name) => room(name)))),
      fetch: (url) => {
        if (isGone) return Promise.reject(new TypeError("Failed to fetch"));
        const asked = /rooms\/(.+)$/.exec(url)?.[1];
        const ok = asked === undefined || names.includes(asked);
        return Promise.resolve({ ok, status: ok ? 200 : 404, json: () => Promise.resolve({ rooms: names.map((name) => ({ name })) }) });
      },
    };
  }
  const leads = (search: string, names: string[]): Promise<boolean> => leadsToFront(search, `ws://h/ws/${new URLSearchParams(search).get("room") ?? ""}`, "", world(names));

  it("without a room leads to the front of several rooms, and to the water of a single one", async () => {
    expect(await leads("?quality=low", ["main", "second"])).toBe(true);
    expect(await leads("", ["main"])).toBe(false);
  });

  it("leads to a room that exists, and to the front instead of one that does not", async () => {
    expect(await leads("?room=second", ["main", "second"])).toBe(false);
    expect(await leads("?room=nope", ["main", "second"])).toBe(true);
    expect(await leads("?room=nope", ["main"])).toBe(true);
  });

  it("leads to the water where the server cannot tell", async () => {
    expect(await leads("", [])).toBe(false);
    expect(await leads("?room=nope", [])).toBe(false);
  });

  it("of a frame, of a projector, of a kiosk with a room and with a scene to open leads to the water", async () => {
    for (const search of ["?embed", "?class", "?scene=pool", "?room=nope&scene=pool", "?room=nope&embed", "?room=nope&kiosk"]) expect(await leads(search, ["main", "second"])).toBe(false);
  });
});

describe("the rooms", () => {
  it("are paused, asleep or running", () => {
    expect([room("a", { isPaused: true, isAsleep: true }), room("a", { isAsleep: true }), room("a")].map(stateOf)).toEqual(["paused", "asleep", "running"]);
  });

  const names = Array.from({ length: 20 }, (_, k) => `room${k}`);

  it("are live in the window only, and none of a hidden page", () => {
    expect(chooseLive(["b"], new Set(["a"]), false)).toEqual(["b"]);
    expect(chooseLive(["a", "b"], new Set(["a"]), true)).toEqual([]);
  });

  it("beyond the bound stay live if they are, and the first ones fill the rest", () => {
    const chosen = chooseLive(names, new Set(["room19", "gone"]), false);
    expect(chosen).toEqual(["room19", ...names.slice(0, 11)]);
  });

  it("fill the card: square waters across it, channels at least in part, without losing more than the rest", () => {
    expect(pictureWidthPercent(1)).toBe(100);
    expect(pictureWidthPercent(3)).toBe(100);
    for (const aspectRatio of [0.05, 0.2, 1, 3, 16, 60]) {
      const width = pictureWidthPercent(aspectRatio) / 100;
      const height = (1.6 * width) / aspectRatio;
      expect(Math.max(height, width)).toBeGreaterThanOrEqual(0.44);
      if (aspectRatio > 4) expect(height).toBeCloseTo(0.45, 1);
      if (aspectRatio < 0.5) expect(1 / height).toBeCloseTo(0.45, 1);
    }
  });
});
