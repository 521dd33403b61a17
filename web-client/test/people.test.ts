import { describe, expect, it } from "vitest";

import { parse } from "../client/codec/parse";
import { Role, Team } from "../client/gen/spindrift/v1/wire_pb";
import { IdentityStore, type StorageLike } from "../src/net/identity_store";
import { Rig } from "./fakes";
import { encode } from "./wire";

const welcome = { case: "welcome" as const, value: { role: Role.PLAYER, personId: 3, resumeKey: "key", graceS: 20, resumed: false } };

function storage(): StorageLike & { map: Map<string, string> } {
  const map = new Map<string, string>();
  return { map, getItem: (key) => map.get(key) ?? null, setItem: (key, value) => void map.set(key, value) };
}

describe("people in messages", () => {
  it("are read with CSS colours", () => {
    const person = { personId: 3, name: "Ada", colorRgb: 0x0a0b0c, role: Role.OPERATOR, boatIds: [2, 5], away: true, team: Team.BLUE, muted: true };
    expect(parse(encode({ case: "people", value: { people: [person], unlistedCount: 930 } }))).toEqual({
      kind: "people",
      unlistedCount: 930,
      people: [{ personId: 3, name: "Ada", color: "#0a0b0c", role: "operator", boatIds: [2, 5], away: true, team: "blue", muted: true }],
    });
  });

  it("have no others where the server does not say so", () => {
    expect(parse(encode({ case: "people", value: {} }))).toEqual({ kind: "people", people: [], unlistedCount: 0 });
  });

  it("with a role that this page does not know are viewers", () => {
    expect(parse(encode({ case: "welcome", value: { ...welcome.value, role: 9 as Role } }))).toMatchObject({ kind: "welcome", welcome: { role: "viewer" } });
  });
});

describe("the identity of the page", () => {
  it("reconnects with the resume key of the last Welcome", () => {
    const rig = new Rig();
    rig.socket.open();
    expect(rig.socket.sent[0]).toMatchObject({ case: "hello", value: { name: "", token: "", resumeKey: "" } });
    rig.socket.deliver(welcome);
    expect(rig.eventsOf("welcome")).toEqual([{ kind: "welcome", welcome: { role: "player", personId: 3, resumeKey: "key", resumed: false } }]);
    rig.socket.drop();
    rig.time.advance(8000);
    rig.socket.open();
    expect(rig.sockets).toHaveLength(2);
    expect(rig.socket.sent[0]).toMatchObject({ value: { resumeKey: "key" } });
  });

  it("reconnects with another name, also after a refusal, as the same person", () => {
    const rig = new Rig();
    rig.socket.open();
    rig.socket.deliver(welcome);
    rig.socket.deliver({ case: "refusal", value: { message: "the token has expired" } });
    expect(rig.state).toEqual({ name: "refused", reason: "the token has expired", rooms: [] });
    rig.connection.introduce("Ada", "secret");
    rig.socket.open();
    expect(rig.socket.sent[0]).toMatchObject({ value: { name: "Ada", token: "secret", resumeKey: "key" } });
    expect(rig.socket.url).not.toContain("secret");
  });

  it("sends a long token, such as a JSON Web Token, as a whole", () => {
    const rig = new Rig();
    rig.socket.open();
    const token = `${"a".repeat(40)}.${"b".repeat(4000)}.${"c".repeat(342)}`;
    rig.connection.introduce("Ada", token);
    rig.socket.open();
    expect(rig.socket.sent[0]).toMatchObject({ value: { token } });
  });

  it("is kept for a reload, the resume key for the same room only", () => {
    const kept = storage();
    const ada = { name: "Ada", token: "secret", resumeKey: "key" };
    new IdentityStore(kept, "ws://host/ws").leave(ada);
    expect(new IdentityStore(kept, "ws://host/ws").load()).toEqual(ada);
    new IdentityStore(kept, "ws://host/ws").leave(ada);
    expect(new IdentityStore(kept, "ws://host/ws/other").load()).toEqual({ ...ada, resumeKey: "" });
  });

  it("stores no resume key while the page is open", () => {
    const kept = storage();
    const ada = { name: "Ada", token: "secret", resumeKey: "key" };
    const first = new IdentityStore(kept, "u");
    first.leave(ada);
    expect(first.load()).toEqual(ada);
    first.save(ada);
    expect(new IdentityStore(kept, "u").load()).toEqual({ ...ada, resumeKey: "" });
    first.leave(ada);
    expect(new IdentityStore(kept, "u").load()).toEqual(ada);
  });

  it("is empty without storage or with invalid content", () => {
    const nobody = { name: "", token: "", resumeKey: "" };
    expect(new IdentityStore(undefined, "u").load()).toEqual(nobody);
    for (const text of ["", "{", "null", "7", '{"name":7,"url":"u"}']) {
      const kept = storage();
      kept.map.set("spindrift-identity", text);
      expect(new IdentityStore(kept, "u").load()).toEqual(nobody);
    }
    const forbidden: StorageLike = {
      getItem: () => { throw new Error("forbidden"); },
      setItem: () => { throw new Error("full"); },
    };
    expect(new IdentityStore(forbidden, "u").load()).toEqual(nobody);
    expect(() => new IdentityStore(forbidden, "u").save(nobody)).not.toThrow();
  });
});
