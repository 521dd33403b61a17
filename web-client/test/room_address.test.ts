// Rooms in the page's address, and how they are opened.
import { describe, expect, it } from "vitest";

import { openRoom } from "../src/net/open_room";
import { roomOf, textOfValues, wishOf } from "../src/net/room_address";

describe("the room of an address", () => {
  it("is the one that it names, or that of its scene", () => {
    expect(roomOf("")).toBe("");
    expect(roomOf("?room=lab")).toBe("lab");
    expect(roomOf("?scene=pool&light=dusk")).toBe("pool");
    expect(roomOf("?room=lab&scene=pool&set=wave.depth_m:2")).toBe("lab");
    expect(roomOf("?scene=../x y")).toBe("---x-y");
  });

  it("is the same for the same values and another one for others", () => {
    const room = roomOf("?scene=pool&set=wave.depth_m:2,storm.level_ratio:0.5");
    expect(room).toMatch(/^pool-[0-9a-f]{8}$/);
    expect(roomOf("?set=storm.level_ratio:0.50,wave.depth_m:2.0&scene=pool")).toBe(room);
    expect(roomOf("?scene=pool&set=wave.depth_m:2.1,storm.level_ratio:0.5")).not.toBe(room);
    expect(roomOf(`?scene=${"a".repeat(40)}&set=wave.depth_m:2`)).toMatch(/^a{23}-[0-9a-f]{8}$/);
  });

  it("has values only of a scene, and leaves out the rest", () => {
    expect(wishOf("?set=wave.depth_m:2")).toBeUndefined();
    expect(wishOf("?scene=")).toBeUndefined();
    expect(wishOf("?scene=pool")).toEqual({ scene: "pool", parameters: [] });
    expect(wishOf("?scene=pool&set=wave.depth_m:1e-3,a:,b:1x,:3,c:Infinity,D:1,e.f:-2")).toEqual({ scene: "pool", parameters: [{ path: "wave.depth_m", value: 0.001 }, { path: "e.f", value: -2 }] });
    expect(textOfValues([{ path: "b", value: 0.5 }, { path: "a.c_m", value: 2 }])).toBe("a.c_m:2,b:0.5");
  });
});

describe("opening a room", () => {
  const kWish = { scene: "pool", parameters: [{ path: "wave.depth_m", value: 2 }] };

  /** A server that answers requests in this order. */
  async function openAt(...replies: [status: number, message?: string][]) {
    const asked: [url: string, init: RequestInit][] = [];
    const why = await openRoom("wss://h/water/ws/lab", "secret", kWish, (url, init) => {
      asked.push([url, init]);
      const [status, message] = replies[Math.min(asked.length, replies.length) - 1]!;
      return Promise.resolve({ ok: status < 300, status, json: () => Promise.resolve({ message }) });
    }, () => Promise.resolve());
    return { why, asked };
  }

  it("asks for name, scene and values beside the socket, with the token in a header", async () => {
    const { why, asked } = await openAt([201]);
    expect(why).toBeUndefined();
    const [[url, init]] = asked as [[string, RequestInit]];
    expect(url).toBe("https://h/water/api/v1/rooms");
    expect(init).toMatchObject({ method: "POST", headers: { Authorization: "Bearer secret", "Content-Type": "application/json" } });
    expect(JSON.parse(String(init.body))).toEqual({ name: "lab", scene: "pool", parameters: [{ path: "wave.depth_m", value: 2 }] });
  });

  it("waits for a room that somebody else opens, or that takes the server long", async () => {
    for (const status of [409, 504]) {
      const { why, asked } = await openAt([status, "not yet"], [404], [404], [200]);
      expect(why).toBeUndefined();
      expect(asked.map(([url]) => url).slice(1)).toEqual(Array(3).fill("https://h/water/api/v1/rooms/lab"));
    }
  });

  it("returns the server's reason, and for a visitor without the right what to do", async () => {
    expect((await openAt([503, "the limit of 8 rooms is reached"])).why).toBe("the limit of 8 rooms is reached");
    expect((await openAt([403, "opening a room takes the role of operator"])).why).toMatch(/^opening a room takes the role of operator\. Open the operator's link/);
    expect((await openAt([409, "the scene is wrong"], [404])).why).toBe("the scene is wrong");
  });
});
