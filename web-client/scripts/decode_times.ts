// Measures how long the worker takes for one frame of the surface and one of the particles: `npm run bench`, in Node or, with
// --chromium, in a worker of a browser.
import { fromBinary } from "@bufbuild/protobuf";

import { FrameUnpacker } from "../client/codec/frame_unpacker";
import { parseFrame } from "../client/codec/parse_frame";
import { ServerMessageSchema } from "../client/gen/spindrift/v1/wire_pb";

interface DecodeTimes {
  frames: number;
  particles: number;
  resolution: number;
  /** Milliseconds per surface, per particle frame and for both; sorted. */
  surfaceMs: number[];
  particlesMs: number[];
  bothMs: number[];
}

/** Messages of a file made by tests/bench/packed_frames, surface and particles in turn. */
function messagesOf(file: Uint8Array): Uint8Array[] {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const messages: Uint8Array[] = [];
  for (let at = 0; at < file.length; ) {
    const size = view.getUint32(at, true);
    messages.push(file.slice(at + 4, at + 4 + size));
    at += 4 + size;
  }
  return messages;
}

const buffers = new Map<number, Uint8Array>();
function bufferOf(bytesCount: number): Uint8Array {
  let buffer = buffers.get(bytesCount);
  if (!buffer) buffers.set(bytesCount, (buffer = new Uint8Array(bytesCount)));
  return buffer;
}

/** Reads all frames `rounds` times after three warm-up rounds. The first frame of each round, a keyframe, is not counted. */
export function measureDecoding(file: Uint8Array, rounds: number): DecodeTimes {
  const messages = messagesOf(file);
  const times: DecodeTimes = { frames: messages.length / 2, particles: 0, resolution: 0, surfaceMs: [], particlesMs: [], bothMs: [] };
  const unpacker = new FrameUnpacker(); // as in the page: new ones each round would be garbage that it never makes
  for (let round = -3; round < rounds; ++round) {
    unpacker.forget();
    let surfaceMs = 0;
    messages.forEach((bytes, k) => {
      const begin = performance.now();
      const message = fromBinary(ServerMessageSchema, bytes);
      if (message.message.case !== "frame") throw new Error("not a frame");
      const parsed = parseFrame(message.message.value);
      const frame = parsed.kind === "packedSurface" || parsed.kind === "packedParticles" ? unpacker.unpack(parsed) : parsed;
      // Like the worker: into a buffer that the page has returned.
      if ("payload" in frame) bufferOf(frame.payload.length).set(frame.payload);
      const ms = performance.now() - begin;
      if (frame.kind === "surface") times.resolution = frame.header.resolutionCount;
      else if (frame.kind === "particles") times.particles = frame.header.count;
      else throw new Error(`message ${k}: ${frame.kind === "malformed" ? frame.reason : frame.kind}`);
      if (round < 0 || k < 2) return;
      if (frame.kind === "surface") {
        surfaceMs = ms;
      } else {
        times.surfaceMs.push(surfaceMs);
        times.particlesMs.push(ms);
        times.bothMs.push(surfaceMs + ms);
      }
    });
  }
  for (const list of [times.surfaceMs, times.particlesMs, times.bothMs]) list.sort((a, b) => a - b);
  return times;
}
