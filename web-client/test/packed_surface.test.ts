// The packed surface through a connection: lost frames and how the surface recovers.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fromBinary } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";

import { crc32c } from "../client/codec/frame_reader";
import { Packing, ServerMessageSchema } from "../client/gen/spindrift/v1/wire_pb";
import { Rig } from "./fakes";
import { type ServerBody } from "./wire";

function golden(name: string): Uint8Array {
  return readFileSync(join(import.meta.dirname, "..", "..", "tests", "golden", `${name}.bin`));
}

const frames = [0, 1, 2].map((k) => golden(`surface_packed_${k}`));

/** The frame without the last bytes of its payload, with the checksum of the rest. */
function damaged(name: string): ServerBody {
  const { message } = fromBinary(ServerMessageSchema, golden(name));
  if (message.case !== "frame") throw new Error("not a frame");
  const payload = message.value.payload.slice(0, -3);
  return { case: "frame", value: { ...message.value, payload, crc32c: crc32c(payload) } } as ServerBody;
}

function deliver(rig: Rig, k: number): void {
  const bytes = frames[k]!;
  rig.socket.onmessage!({ data: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) });
}

describe("packed frames", () => {
  it("is subscribed to and delivered as plain samples", () => {
    const rig = Rig.live();
    expect(rig.socket.sentOf("subscribe").every(({ value }) => value.packing === Packing.PACKED)).toBe(true);
    for (const k of [0, 1, 2]) deliver(rig, k);
    const arrived = rig.frames;
    expect(arrived.map(({ kind, header }) => [kind, header.tick])).toEqual([["surface", 100n], ["surface", 102n], ["surface", 104n]]);
    expect(arrived.every(({ payload }) => payload.length === 2 * 20 * 20)).toBe(true);
  });

  it("continues with a keyframe after a lost frame, and requests one at most once per second", () => {
    const rig = Rig.live();
    const askedCount = (): number => rig.socket.sentOf("subscribe").length;
    const before = askedCount();
    deliver(rig, 1);
    expect(rig.frames).toHaveLength(0);
    const once = askedCount();
    expect(once).toBeGreaterThan(before);
    deliver(rig, 2);
    expect(askedCount()).toBe(once);
    deliver(rig, 0);
    deliver(rig, 1);
    expect(rig.frames).toHaveLength(2);
    deliver(rig, 1); // builds on 0, but the last frame was 1
    expect(rig.frames).toHaveLength(2);
  });

  it("requests a keyframe after a damaged plane, but not after damaged particles", () => {
    const rig = Rig.live();
    const askedCount = (): number => rig.socket.sentOf("subscribe").length;
    const before = askedCount();
    rig.socket.deliver(damaged("particles_packed"));
    expect(askedCount()).toBe(before);
    rig.socket.deliver(damaged("surface_packed_0"));
    expect(askedCount()).toBeGreaterThan(before);
    rig.time.advance(500);
    expect(rig.lastStats()).toMatchObject({ malformedCount: 2, receivedCount: { surface: 0, particles: 0 } });
  });

  it("uses no plane from before a reconnection", () => {
    const rig = Rig.live();
    deliver(rig, 0);
    rig.connection.stop();
    rig.connection.start();
    rig.greet();
    deliver(rig, 1);
    expect(rig.frames).toHaveLength(1);
  });
});
