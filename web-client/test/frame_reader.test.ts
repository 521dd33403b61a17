// The WebAssembly reader with bytes that no server sends: it refuses them and reads the next good frame.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it, vi } from "vitest";
import { create, fromBinary, toBinary } from "@bufbuild/protobuf";

import { crc32c, readerFault } from "../client/codec/frame_reader";
import { FrameUnpacker } from "../client/codec/frame_unpacker";
import { parse } from "../client/codec/parse";
import { ServerMessageSchema, type LayerFrame, type ServerMessage } from "../client/gen/spindrift/v1/wire_pb";
import { isPacked } from "./wire";

/** Long enough for thousands of frames on a busy machine. */
vi.setConfig({ testTimeout: 60_000 });

const kFiles = ["surface_packed_0", "surface_packed_1", "foam_packed_0", "foam_packed_1", "particles_packed", "floaters_packed_0", "floaters_packed_1"];
const kRefusals = /does not hold|end does not fit/;

function messageOf(file: string): ServerMessage {
  return fromBinary(ServerMessageSchema, readFileSync(join(import.meta.dirname, "..", "..", "tests", "golden", `${file}.bin`)));
}

function frameOf(message: ServerMessage): LayerFrame {
  if (message.message.case !== "frame") throw new Error("not a frame");
  return message.message.value;
}

/** Returns the frame with another payload and its checksum. */
function bytesWith(message: ServerMessage, payload: Uint8Array): ArrayBuffer {
  const frame = { ...frameOf(message), payload, crc32c: crc32c(payload) };
  const bytes = toBinary(ServerMessageSchema, create(ServerMessageSchema, { message: { case: "frame", value: frame } }));
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) as ArrayBuffer;
}

const unpacker = new FrameUnpacker();

/** Reads the frame as the page does, after the keyframe that a delta needs. */
function read(file: string, payload?: Uint8Array): { kind: string; reason?: string; payload?: Uint8Array } {
  const message = messageOf(file);
  unpacker.forget();
  if (file.endsWith("_1")) readInto(bytesWith(messageOf(file.replace("_1", "_0")), frameOf(messageOf(file.replace("_1", "_0"))).payload));
  return readInto(bytesWith(message, payload ?? frameOf(message).payload));
}

function readInto(bytes: ArrayBuffer): { kind: string; reason?: string; payload?: Uint8Array } {
  const parsed = parse(bytes);
  return isPacked(parsed) ? unpacker.unpack(parsed) : (parsed as { kind: string });
}

function expectHarmless(result: { kind: string; reason?: string }): void {
  if (result.kind === "malformed") expect(result.reason).toMatch(kRefusals);
  else expect(["surface", "foam", "particles", "floaters"]).toContain(result.kind);
}

/** Pseudo-random numbers from a fixed seed. */
function* noise(seed: number): Generator<number> {
  for (let state = seed; ; ) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield state >>> 8;
  }
}

describe("the frame reader", () => {
  it("runs here", () => {
    expect(readerFault()).toBeUndefined();
  });

  it("says in one line what a browser lacks", async () => {
    vi.resetModules();
    vi.stubGlobal("WebAssembly", undefined);
    const { readerFault: fault } = await import("../client/codec/frame_reader");
    expect(fault()).toMatch(/^packed frames cannot be read here, for want of WebAssembly with SIMD .*$/);
    vi.unstubAllGlobals();
  });

  it.each(kFiles)("refuses %s cut short anywhere", (file) => {
    const { payload } = frameOf(messageOf(file));
    for (let length = 0; length < payload.length; length += 3) expect(read(file, payload.slice(0, length))).toMatchObject({ kind: "malformed" });
  });

  it.each(kFiles)("refuses %s with extra bytes", (file) => {
    const { payload } = frameOf(messageOf(file));
    for (const more of [1, 8, 1000]) {
      const longer = new Uint8Array(payload.length + more);
      longer.set(payload);
      expect(read(file, longer).kind).toBe("malformed");
    }
  });

  it.each(kFiles)("reads or refuses %s with flipped bits, and reads the good frame afterwards", (file) => {
    const { payload } = frameOf(messageOf(file));
    const good = read(file).payload!.slice();
    for (let bit = 0; bit < 8 * payload.length; bit += 13) {
      const damaged = payload.slice();
      damaged[bit >> 3]! ^= 1 << (bit & 7);
      expectHarmless(read(file, damaged));
    }
    expect(read(file).payload).toEqual(good);
  });

  it.each(kFiles)("survives random bytes as %s", (file) => {
    const random = noise(kFiles.indexOf(file) + 1);
    for (let round = 0; round < 100; ++round) {
      const payload = new Uint8Array(random.next().value! % 3000);
      for (let at = 0; at < payload.length; ++at) payload[at] = random.next().value!;
      expectHarmless(read(file, payload));
    }
  });

  it("refuses a plane and particles of the largest size with too short a payload", () => {
    for (const file of ["surface_packed_0", "particles_packed"]) {
      const message = messageOf(file);
      const { codec } = frameOf(message);
      if (codec.case === "surfacePredicted") codec.value.resolutionCount = 4096;
      if (codec.case === "particlesByCell") codec.value.count = 4 * 1024 * 1024;
      expect(readInto(bytesWith(message, frameOf(message).payload))).toMatchObject({ kind: "malformed" });
    }
  });
});
