import { describe, expect, it } from "vitest";

import { planMove } from "../client/session/move_plan";
import { Rig } from "./fakes";
import { type ServerBody } from "./wire";

const kSameServer = { closesInS: 1, goTo: "", reconnectAfterMinS: 2, reconnectAfterMaxS: 4 };

function draining(value = kSameServer): ServerBody {
  return { case: "draining", value };
}

/** A connection with a person, whose server says that it ends. */
function drainingRig(value = kSameServer, random = 0.5): Rig {
  const rig = new Rig(random);
  rig.greet();
  rig.socket.deliver({ case: "welcome", value: { personId: 3, resumeKey: "the key" } });
  rig.time.advance(10_000 - 1);
  rig.socket.deliver({ case: "pong", value: {} });
  rig.socket.deliver(draining(value));
  return rig;
}

describe("a server that is about to end", () => {
  it("keeps its connection and resumes at the random moment", () => {
    const rig = drainingRig();
    expect(rig.state.name).toBe("live");
    expect(rig.eventsOf("draining")).toEqual([{ kind: "draining", draining: kSameServer }]);
    rig.time.advance(1000);
    rig.socket.drop(1001, "server is shutting down");
    expect(rig.state).toEqual({ name: "retrying", inS: 2, why: "the server restarts" });
    rig.time.advance(1999);
    expect(rig.sockets).toHaveLength(1);
    rig.time.advance(1);
    expect(rig.sockets).toHaveLength(2);
    expect(rig.socket.url).toBe("ws://host/ws");
    rig.socket.open();
    expect(rig.socket.sentOf("hello")[0]?.value.resumeKey).toBe("the key");
  });

  it("spreads its clients over the range that it gives", () => {
    const at = (random: number) => planMove(kSameServer, "ws://host/ws", random, 1000).atMs;
    expect(at(0)).toBe(3000);
    expect(at(0.5)).toBe(4000);
    expect(at(0.999)).toBeCloseTo(4998);
  });

  it("sends its clients elsewhere, to the same room, before it closes", () => {
    const rig = drainingRig({ closesInS: 4, goTo: "wss://other.example:8443", reconnectAfterMinS: 0, reconnectAfterMaxS: 4 }, 0.25);
    const old = rig.socket;
    rig.time.advance(1000);
    expect(old.closed).toBe(true);
    expect(rig.socket.url).toBe("wss://other.example:8443/ws");
    expect(planMove({ ...kSameServer, goTo: "ws://a/" }, "wss://b:1/ws/pond", 0, 0).url).toBe("ws://a/ws/pond");
    rig.greet();
    rig.time.advance(6000);
    rig.socket.deliver({ case: "pong", value: {} });
    rig.socket.drop();
    rig.time.advance(10_000);
    expect(rig.socket.url).toBe("wss://other.example:8443/ws"); // the move is for good
  });

  it("is tried again with growing pauses when it is not back in time", () => {
    const rig = drainingRig();
    rig.socket.drop(1001);
    rig.time.advance(3000);
    expect(rig.sockets).toHaveLength(2);
    rig.socket.drop();
    expect(rig.state).toMatchObject({ name: "retrying", inS: 0.5 });
    rig.time.advance(500);
    expect(rig.sockets).toHaveLength(3);
  });

  it("is connected to at once when the user asks for it", () => {
    const rig = drainingRig();
    rig.socket.drop(1001);
    rig.connection.retryNow();
    expect(rig.sockets).toHaveLength(2);
    rig.time.advance(3000);
    expect(rig.sockets).toHaveLength(2);
  });

  it("rejects the commands that it has not answered", () => {
    const rig = drainingRig();
    rig.connection.command(7, { case: "reset", value: {} });
    rig.socket.drop(1001);
    expect(rig.eventsOf("reject")).toMatchObject([{ commandId: 7n, message: "the server restarts" }]);
  });

  it.each([
    { closesInS: Number.NaN },
    { reconnectAfterMinS: -1 },
    { reconnectAfterMinS: 5 },
    { reconnectAfterMaxS: Number.POSITIVE_INFINITY },
    { goTo: "https://other.example" },
    { goTo: "wss://other.example/path" },
    { goTo: "wss://user@other.example" },
    { goTo: "javascript:alert(1)" },
  ])("is not believed when it says %o", (change) => {
    const rig = drainingRig({ ...kSameServer, ...change });
    expect(rig.eventsOf("draining")).toEqual([]);
    rig.socket.drop(1001);
    expect(rig.state).toMatchObject({ name: "retrying", why: expect.stringContaining("1001") });
  });

  it("does not keep a client waiting for longer than a minute", () => {
    expect(planMove({ ...kSameServer, reconnectAfterMaxS: 1e9 }, "ws://host/ws", 0.9, 0).atMs).toBe(60_000);
  });
});
