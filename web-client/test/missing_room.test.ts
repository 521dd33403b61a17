// A room that does not exist: what REST is asked, and what the connection does then.
import { describe, expect, it } from "vitest";

import { findMissingRoom, type Fetch } from "../client/session/missing_room";
import { Rig } from "./fakes";

/** A server with these replies by URL; others fail as a server that is gone. */
function serverOf(replies: Record<string, { status: number; body?: unknown }>): { fetch: Fetch; asked: string[] } {
  const asked: string[] = [];
  const fetch: Fetch = (url) => {
    asked.push(url);
    const reply = replies[url];
    if (!reply) return Promise.reject(new TypeError("Failed to fetch"));
    return Promise.resolve({ ok: reply.status === 200, status: reply.status, json: () => Promise.resolve(reply.body) });
  };
  return { fetch, asked };
}

describe("the question for a missing room", () => {
  const list = { status: 200, body: { rooms: [{ name: "main" }, { name: "tank" }] } };

  it("is asked beside the socket, and answered with the rooms that there are", async () => {
    const { fetch } = serverOf({ "https://h/water/api/v1/rooms/no%20pe": { status: 404 }, "https://h/water/api/v1/rooms": list });
    expect(await findMissingRoom("wss://h/water/ws/no%20pe", "", fetch)).toEqual({ name: "no pe", rooms: ["main", "tank"] });
  });

  it("has no answer for an existing room or without a server", async () => {
    const room = "http://h:1/api/v1/rooms/pool";
    for (const replies of [{ [room]: { status: 200 } }, { [room]: { status: 401 } }, {}, { [room]: { status: 404 } }, { [room]: { status: 404 }, "http://h:1/api/v1/rooms": { status: 200, body: {} } }])
      expect(await findMissingRoom("ws://h:1/ws/pool", "", serverOf(replies).fetch)).toBeUndefined();
    const { fetch, asked } = serverOf({});
    expect(await findMissingRoom("ws://h:1/ws", "", fetch)).toBeUndefined();
    expect(asked).toEqual([]);
  });
});

describe("a connection to a missing room", () => {
  const settled = (): Promise<void> => new Promise((done) => setTimeout(done));

  it("ends with the rooms that there are, and can be tried again", async () => {
    const rig = new Rig();
    rig.missing = { name: "nope", rooms: ["main"] };
    rig.socket.drop();
    await settled();
    expect(rig.state).toEqual({ name: "refused", reason: "there is no room nope", rooms: ["main"] });
    rig.time.advance(60_000);
    expect(rig.sockets).toHaveLength(1);
    rig.missing = undefined;
    rig.connection.retryNow();
    rig.greet();
    expect(rig.state.name).toBe("live");
  });

  it("opens it if the page's address has a scene, and enters it then", async () => {
    const rig = new Rig();
    rig.missing = { name: "pool", rooms: ["main"] };
    let opened: (whyNot: string | undefined) => void = () => {};
    rig.whyNotOpened = () => new Promise((done) => (opened = done));
    rig.socket.drop();
    await settled();
    expect(rig.state).toEqual({ name: "opening", room: "pool" });
    rig.time.advance(60_000);
    expect(rig.sockets, "no attempt meanwhile").toHaveLength(1);
    opened(undefined);
    await settled();
    expect(rig.sockets).toHaveLength(2);
    rig.greet();
    expect(rig.state.name).toBe("live");

    rig.socket.drop(4404, "the room was closed");
    rig.time.advance(2000);
    rig.socket.drop();
    await settled();
    expect(rig.state, "what was closed on purpose stays closed").toEqual({ name: "refused", reason: "there is no room pool", rooms: ["main"] });
  });

  it("says why it may not open it, and what rooms there are", async () => {
    const rig = new Rig();
    rig.missing = { name: "pool", rooms: ["main"] };
    rig.whyNotOpened = () => Promise.resolve("the limit of 8 rooms is reached");
    rig.socket.drop();
    await settled();
    expect(rig.state).toEqual({ name: "refused", reason: "there is no room pool: the limit of 8 rooms is reached", rooms: ["main"] });
  });

  it("that the server closes is known to be missing, with the rooms that there are", async () => {
    const rig = Rig.live();
    rig.missing = { name: "pool", rooms: ["main"] };
    rig.socket.deliver({ case: "refusal", value: { message: "the room was closed" } });
    await settled();
    expect(rig.state).toEqual({ name: "refused", reason: "the room was closed", rooms: ["main"] });
  });

  it("is retried until it is known to be missing", async () => {
    const rig = new Rig();
    rig.socket.drop();
    await settled();
    expect(rig.state.name).toBe("retrying");
    rig.time.advance(500);
    rig.socket.open();
    rig.socket.drop();
    await settled();
    expect(rig.askedCount).toBe(1);
  });

  it("does not end a later attempt", async () => {
    const rig = new Rig();
    rig.missing = { name: "nope", rooms: ["main"] };
    rig.socket.drop();
    rig.time.advance(500);
    rig.greet();
    await settled();
    expect(rig.state.name).toBe("live");
  });
});
