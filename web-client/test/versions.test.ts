// Messages of every minor version of the wire, read by this client (tests/golden/versions.txt).
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fromBinary } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";

import { kWireMinor } from "../client/codec/greeting";
import { parse } from "../client/codec/parse";
import { ServerMessageSchema } from "../client/gen/spindrift/v1/wire_pb";
import { Rig } from "./fakes";
import { greeting } from "./wire";

const lines = readFileSync(join(import.meta.dirname, "..", "..", "tests", "golden", "versions.txt"), "utf8").split("\n").filter((line) => line !== "" && !line.startsWith("#"));
const said = lines.map((line) => line.split(" ") as [string, string, string, string]).filter(([, side]) => side === "server").map(([version, , kind, hex]) => ({ version, kind, bytes: Uint8Array.from(Buffer.from(hex, "hex")).buffer }));
const versions = [...new Set(said.map(({ version }) => version))];
const camel = (name: string): string => name.replace(/_([a-z])/g, (_, letter: string) => letter.toUpperCase());

describe("a server of another minor version", () => {
  it("is any from 1.0 to that of this client", () => {
    expect(versions).toEqual(Array.from({ length: kWireMinor + 1 }, (_, minor) => `1.${minor}`));
  });

  it("may be newer, with messages that this client does not know", () => {
    const rig = new Rig();
    rig.socket.open();
    rig.socket.deliver(greeting({ version: { major: 1, minor: kWireMinor + 7 } }));
    rig.socket.onmessage?.({ data: Uint8Array.of(0xfa, 0x7f, 3, 97, 98, 99).buffer });
    rig.socket.deliver({ case: "roomState", value: { paused: true, speed: 1 } });
    expect(rig.state.name).toBe("live");
    expect(rig.eventsOf("roomState")).toMatchObject([{ paused: true }]);
    rig.time.advance(600);
    expect(rig.lastStats().malformedCount).toBe(0);
  });

  it.each(versions)("%s is understood", (version) => {
    const rig = new Rig();
    rig.socket.open();
    // A version has lines for what differs from the one before.
    const until = versions.slice(0, versions.indexOf(version) + 1);
    const messages = new Map(said.filter((message) => until.includes(message.version)).map(({ kind, bytes }) => [kind, bytes]));
    expect([...messages.keys()][0]).toBe("greeting");
    for (const [kind, bytes] of messages) {
      const { case: known } = fromBinary(ServerMessageSchema, new Uint8Array(bytes)).message;
      expect(known).toBe(camel(kind));
      expect(parse(bytes).kind, `${version} ${kind}`).toBe(known);
      // These end the session.
      if (kind !== "refusal" && kind !== "draining") rig.socket.onmessage?.({ data: bytes });
    }
    expect(rig.state.name).toBe("live");
    expect(rig.eventsOf("greeting")[0]!.greeting).toMatchObject({ versionMajor: 1, versionMinor: Number(version.split(".")[1]), sideM: 8 });
    expect(rig.eventsOf("people")).toHaveLength(1);
    rig.time.advance(600);
    expect(rig.lastStats().malformedCount).toBe(0);
  });
});
