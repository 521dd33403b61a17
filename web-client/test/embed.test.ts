// The messages between the page of `?embed` and the page around it, the frame's address, and the code that embeds a room.
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";

import { frameAddress, kPageAttributes } from "../element/address";
import { envelope, kTextMaxLength, readFrameMessage, readParentMessage } from "../element/protocol";
import { ParentLink } from "../src/embed/parent_link";
import { parentsOf } from "../src/net/frame_policy";
import { embedCode } from "../src/ui/embed_code";

const kParent = "https://school.example";

describe("messages", () => {
  it("of a request are read with their fields, and nothing else", () => {
    const splash = { spindrift: 1, kind: "splash", id: 3, xM: 1, zM: -2, radiusM: 0.5, other: "x" };
    expect(readParentMessage(splash)).toEqual({ kind: "splash", id: 3, xM: 1, zM: -2, radiusM: 0.5 });
    expect(readParentMessage({ spindrift: 1, kind: "wave", id: 4 })).toEqual({ kind: "wave", id: 4 });
    expect(readParentMessage(envelope({ kind: "set", id: 5, path: "wave.depth_m", value: 2 }))).toEqual({ kind: "set", id: 5, path: "wave.depth_m", value: 2 });
  });

  it.each<[string, unknown]>([
    ["no object", "splash"],
    ["null", null],
    ["another protocol", { kind: "splash", id: 1, xM: 0, zM: 0 }],
    ["another version", { spindrift: 2, kind: "hello" }],
    ["an unknown kind", { spindrift: 1, kind: "reset", id: 1 }],
    ["a kind of Object", { spindrift: 1, kind: "constructor", id: 1 }],
    ["a kind that is an object", { spindrift: 1, kind: { toString: 1 }, id: 1 }],
    ["no id", { spindrift: 1, kind: "splash", xM: 0, zM: 0 }],
    ["a negative id", { spindrift: 1, kind: "splash", id: -1, xM: 0, zM: 0 }],
    ["a position that is a text", { spindrift: 1, kind: "splash", id: 1, xM: "0", zM: 0 }],
    ["an infinite position", { spindrift: 1, kind: "splash", id: 1, xM: Infinity, zM: 0 }],
    ["a size beyond all water", { spindrift: 1, kind: "splash", id: 1, xM: 0, zM: 0, radiusM: 1e5 }],
    ["no ticks", { spindrift: 1, kind: "step", id: 1, ticks: 0 }],
    ["too many ticks", { spindrift: 1, kind: "step", id: 1, ticks: 601 }],
    ["a path that is too long", { spindrift: 1, kind: "set", id: 1, path: "x".repeat(kTextMaxLength + 1), value: 1 }],
    ["a value that is NaN", { spindrift: 1, kind: "set", id: 1, path: "wave.depth_m", value: NaN }],
    ["a pause that is not true or false", { spindrift: 1, kind: "pause", id: 1, paused: 1 }],
  ])("with %s are invalid", (_what, data) => {
    const reason = readParentMessage(data);
    expect(typeof reason).toBe("string");
    expect((reason as string).length).toBeLessThan(300);
  });

  it("of the frame are read by the same rules", () => {
    expect(readFrameMessage(envelope({ kind: "connected", room: "main", scene: "pool", title: "Pool", role: "viewer" }))).toEqual({ kind: "connected", room: "main", scene: "pool", title: "Pool", role: "viewer" });
    expect(readFrameMessage({ spindrift: 1, kind: "connected", room: "main", scene: "pool", title: "Pool", role: "king" })).toMatch(/role "king"/);
    expect(readFrameMessage({ spindrift: 1, kind: "hello" })).toMatch(/unknown/);
  });
});

describe("the frame policy", () => {
  it("names the pages that may act", () => {
    expect(parentsOf("default-src 'self'; frame-ancestors https://school.example http://localhost:5173; base-uri 'none'")).toEqual([kParent, "http://localhost:5173"]);
  });

  it("names nobody where it is missing, forbids, or has patterns", () => {
    for (const policy of [null, "", "default-src 'self'", "frame-ancestors 'none'", "frame-ancestors *", "frame-ancestors https://*.example 'self' https:"]) expect(parentsOf(policy)).toEqual([]);
  });

  it("of several, as a proxy adds one, takes what all name", () => {
    expect(parentsOf("frame-ancestors https://a.example https://b.example, frame-ancestors https://b.example")).toEqual(["https://b.example"]);
    expect(parentsOf("frame-ancestors https://a.example, frame-ancestors 'none'")).toEqual([]);
  });
});

describe("the link with the parent", () => {
  function linked() {
    const posted: { message: Record<string, unknown>; origin: string }[] = [];
    const sent: unknown[] = [];
    const warnings: string[] = [];
    const clock = { nowMs: 0 };
    const link = new ParentLink([kParent], {
      post: (message, origin) => posted.push({ message: message as Record<string, unknown>, origin }),
      send: (request) => (request.kind === "wave" ? "no waves here" : 100 + sent.push(request)),
      warn: (text) => warnings.push(text),
      nowMs: () => clock.nowMs,
    });
    const take = (data: unknown, origin = kParent, isParent = true): boolean => link.take({ isParent, origin, data });
    const splash = (id: number): object => envelope({ kind: "splash", id, xM: 0, zM: 0 });
    return { link, posted, sent, warnings, clock, take, splash };
  }

  it("says to any parent that it is there, and all else to the one that said hello", () => {
    const { link, posted, take } = linked();
    link.tell({ kind: "people", count: 1 });
    expect(posted).toEqual([{ message: { spindrift: 1, kind: "loaded" }, origin: "*" }]);
    expect(take(envelope({ kind: "hello" }))).toBe(true);
    link.tell({ kind: "people", count: 2 });
    expect(posted.slice(1)).toEqual([{ message: { spindrift: 1, kind: "people", count: 2 }, origin: kParent }]);
  });

  it("answers each request once, with the tick or the reason", () => {
    const { link, posted, sent, take, splash } = linked();
    take(splash(7));
    take(splash(8));
    take(envelope({ kind: "wave", id: 9 }));
    link.acked(101, 55);
    link.rejected(102, "x".repeat(1000));
    link.acked(102, 56);
    link.acked(3, 57);
    expect(sent).toEqual([{ kind: "splash", xM: 0, zM: 0 }, { kind: "splash", xM: 0, zM: 0 }]);
    expect(posted.slice(1).map(({ message }) => message)).toEqual([
      { spindrift: 1, kind: "refused", id: 9, reason: "no waves here" },
      { spindrift: 1, kind: "done", id: 7, tick: 55 },
      { spindrift: 1, kind: "refused", id: 8, reason: `${"x".repeat(kTextMaxLength - 1)}…` },
    ]);
  });

  it("takes nothing from other windows and other origins", () => {
    const { posted, sent, warnings, clock, take, splash } = linked();
    for (const [origin, isParent] of [[kParent, false], ["https://evil.example", true], ["null", true], ["https://school.example.evil", true]] as const) {
      clock.nowMs += 2000;
      expect(take(splash(1), origin, isParent)).toBe(false);
      expect(take(envelope({ kind: "hello" }), origin, isParent)).toBe(false);
    }
    expect(sent).toEqual([]);
    expect(posted).toHaveLength(1);
    expect(warnings).toHaveLength(4);
  });

  it("warns once per second of malformed messages, and is silent about those of others", () => {
    const { sent, warnings, clock, take } = linked();
    for (let i = 0; i < 1000; ++i) take({ spindrift: 1, kind: "splash", id: i });
    expect(warnings).toHaveLength(1);
    clock.nowMs = 1000;
    take({ spindrift: 1, kind: "nothing" });
    take({ source: "some-extension" });
    expect(warnings).toHaveLength(2);
    expect(sent).toEqual([]);
  });

  it("refuses requests beyond its rate, and takes them again later", () => {
    const { posted, sent, clock, take, splash } = linked();
    for (let id = 1; id <= 200; ++id) take(splash(id));
    expect(sent).toHaveLength(120);
    expect(posted.filter(({ message }) => message["kind"] === "refused")).toHaveLength(80);
    clock.nowMs = 1000;
    for (let id = 201; id <= 300; ++id) take(splash(id));
    expect(sent).toHaveLength(180);
  });
});

describe("the frame's address", () => {
  it("has every attribute as a parameter, and the token where no server sees it", () => {
    const values = { room: "a b", view: "side", light: "17.5" };
    expect(frameAddress("https://water.example/", values, "a&b#c").href).toBe("https://water.example/?embed&room=a+b&view=side&light=17.5#token=a%26b%23c");
    expect(frameAddress("https://school.example/water", {}).href).toBe("https://school.example/water/?embed");
  });

  it("is refused for what is no page of a server", () => {
    for (const server of ["", "water.example", "javascript:alert(1)", "wss://water.example/"]) expect(() => frameAddress(server, {})).toThrow(`server "${server}"`);
  });
});

describe("the code that embeds a room", () => {
  it("has the server and what was chosen, and no token", () => {
    expect(embedCode("https://water.example/lab/?room=pool&view=side&quality=low&class&pictures=stepped#token=secret")).toBe(
      '<script type="module" src="https://water.example/lab/element.js"></script>\n<spindrift-water server="https://water.example/lab/" room="pool" view="side" quality="low"></spindrift-water>\n',
    );
  });

  it("shows the same page in its frame", () => {
    const code = embedCode("http://localhost:8080/?room=pool&camera=1,2,3,0,0,0&light=dusk");
    const values = Object.fromEntries([...code.matchAll(/ (\w+)="([^"]*)"/g)].map(([, name, value]) => [name, value]));
    const { server, type: _type, src: _src, ...rest } = values;
    expect(frameAddress(server!, rest).searchParams.get("camera")).toBe("1,2,3,0,0,0");
  });

  it("cannot be left by a value of the address", () => {
    const code = embedCode(`https://water.example/?room=${encodeURIComponent('"><script>alert(1)</script>&amp;')}`);
    expect(code).toContain('room="&quot;&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;amp;"');
  });
});

describe("the document", () => {
  it("has every attribute", () => {
    const text = readFileSync(new URL("../../docs/embedding.md", import.meta.url), "utf8");
    expect([...kPageAttributes, "server", "token"].filter((name) => !text.includes(`\`${name}\``))).toEqual([]);
  });
});
