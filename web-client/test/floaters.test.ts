import { describe, expect, it } from "vitest";

import { kMaxFloaterCount } from "../client/codec/frame_types";
import { parse } from "../client/codec/parse";
import { Layer } from "../client/gen/spindrift/v1/wire_pb";
import type { FloatersFrame } from "../src/net/messages";
import { makeFloaterGeometry } from "../src/scene/floaters/floater_meshes";
import { kFloaterKinds, type FloaterPose } from "../client/codec/floaters";
import { kRadiusSizes, mixFloaters, unpackFloaters, type FloatersState } from "../src/scene/frames/floaters";
import { pickFloater } from "../src/scene/frames/pick_floater";
import { encode, floatersFrame, floatersPayload, greeting, type FloaterRecord } from "./wire";

const kWater = { sideM: 16, widthM: 12 };

function frame(records: Partial<FloaterRecord>[], spareBytes = 0): FloatersFrame {
  const payload = floatersPayload(records);
  const buffer = new ArrayBuffer(payload.length + spareBytes);
  new Uint8Array(buffer).set(payload);
  return { layer: "floaters", tick: 1n, stateId: 0n, timeS: 2.5, serverTimeS: 2.5, level: "full", count: records.length, quantumM: 0.001, buffer };
}

function pose(change: Partial<FloaterPose>): FloaterPose {
  return { floaterId: 1, kind: "crate", xM: 0, yM: 0, zM: 0, turn: [0, 0, 0, 1], sizeM: 1, isHeld: false, ...change };
}

const state = (...floaters: Partial<FloaterPose>[]): FloatersState => ({ timeS: 1, stateId: 0n, floaters: floaters.map(pose) });
/** A turn about the vertical. */
const about = (angleRad: number): FloaterPose["turn"] => [0, Math.sin(angleRad / 2), 0, Math.cos(angleRad / 2)];
const angleOf = ([, y, , w]: FloaterPose["turn"]): number => 2 * Math.atan2(y, w);

describe("a frame of objects on the wire", () => {
  const expectMalformed = (buffer: ArrayBuffer, reason: RegExp): void => expect(parse(buffer)).toMatchObject({ kind: "malformed", reason: expect.stringMatching(reason) });

  it("is read as a view into the message", () => {
    const buffer = encode(floatersFrame(floatersPayload([{}, {}])));
    const parsed = parse(buffer);
    if (parsed.kind !== "floaters") throw new Error(JSON.stringify(parsed));
    expect(parsed.header).toMatchObject({ tick: 9n, timeS: 0.5, count: 2 });
    expect(parsed.payload.buffer).toBe(buffer);
    expect(parse(encode(floatersFrame(new Uint8Array(0))))).toMatchObject({ kind: "floaters", header: { count: 0 } });
  });

  it("is refused with a count that does not fit, a delta, a wrong checksum or another layer", () => {
    for (const count of [kMaxFloaterCount + 1, 0xffffffff]) expectMalformed(encode(floatersFrame(new Uint8Array(28), {}, count)), /at most 1024/);
    expectMalformed(encode(floatersFrame(new Uint8Array(55), {}, 2)), /payload of 55 bytes, header says 56/);
    expectMalformed(encode(floatersFrame(new Uint8Array(28), {}, 0)), /payload of 28 bytes, header says 0/);
    expectMalformed(encode(floatersFrame(floatersPayload([{}]), { crc32c: 1 })), /crc32c/);
    expectMalformed(encode(floatersFrame(floatersPayload([{}]), { layer: Layer.BODIES })), /carries floaters/);
    expectMalformed(encode(floatersFrame(floatersPayload([{}]), { keyframe: false })), /keyframes/);
  });

  it("survives every truncation", () => {
    const whole = new Uint8Array(encode(floatersFrame(floatersPayload([{ floaterId: 9, xMm: -1200 }]))));
    for (let length = 1; length < whole.length; ++length) expect(parse(whole.slice(0, length).buffer).kind).not.toBe("floaters");
  });

  it("unpacks every field with its unit and sign", () => {
    const record = { floaterId: 4_000_000_000, xMm: -1234, yMm: 56, zMm: 7_000_000, turn: [0, -32767, 0, 0], sizeCm: 1000, kind: 8, flags: 1 };
    const { timeS, floaters } = unpackFloaters(frame([{}, record], 100));
    expect(timeS).toBe(2.5);
    expect(floaters).toHaveLength(2);
    expect(floaters[1]).toEqual({ floaterId: 4_000_000_000, kind: "stone", xM: -1.234, yM: 0.056, zM: 7000, turn: [0, -1, 0, 0], sizeM: 10, isHeld: true });
    expect(floaters[0]!.isHeld).toBe(false);
  });

  it("places packed objects by their quantum", () => {
    const { floaters } = unpackFloaters({ ...frame([{ xMm: -250, turn: [0, 0, 0, 256] }]), quantumM: 0.008 });
    expect(floaters[0]).toMatchObject({ xM: -2, turn: [0, 0, 0, 1] });
  });

  it("draws a kind that it does not know as a crate, and ignores a rotation without length", () => {
    expect(unpackFloaters(frame([{ kind: 0 }, { kind: 9 }, { kind: 255 }])).floaters.map(({ kind }) => kind)).toEqual(["crate", "crate", "crate"]);
    expect(unpackFloaters(frame([{ turn: [0, 0, 0, 0] }])).floaters[0]!.turn).toEqual([0, 0, 0, 1]);
  });
});

describe("a room with objects", () => {
  const read = (change: Record<string, unknown>) => {
    const parsed = parse(encode(greeting(change)));
    if (parsed.kind !== "greeting") throw new Error(JSON.stringify(parsed));
    return parsed.greeting;
  };
  const scene = { wave: { resolutionCount: 64, sideM: 16, depthM: 1 }, floaters: {} };

  it("is one whose scene has them and whose server streams them", () => {
    expect(read({ scene, layers: [Layer.SURFACE, Layer.FLOATERS] })).toMatchObject({ hasFloaters: true, layers: ["surface", "floaters"] });
    expect(read({ scene, layers: [Layer.SURFACE] }).hasFloaters).toBe(false);
    expect(read({ layers: [Layer.SURFACE, Layer.FLOATERS] }).hasFloaters).toBe(false);
  });
});

describe("objects between two frames", () => {
  const mix = (from: FloatersState, to: FloatersState, share: number): FloaterPose[] => {
    const poses: FloaterPose[] = [];
    expect(mixFloaters(from, to, share, kWater, poses)).toBe(from.floaters.length);
    return poses;
  };

  it("move on a straight line", () => {
    const [moved] = mix(state({ xM: 0, yM: 1, zM: -2 }), state({ xM: 1, yM: 2, zM: -4 }), 0.25);
    expect(moved).toMatchObject({ xM: 0.25, yM: 1.25, zM: -2.5 });
  });

  it("turn the shorter way, whichever of its two quaternions a rotation has", () => {
    for (const sign of [1, -1]) {
      const to = about(1.2).map((each) => sign * each) as FloaterPose["turn"];
      const { turn } = mix(state({ turn: about(0.4) }), state({ turn: to }), 0.5)[0]!;
      expect(Math.hypot(...turn)).toBeCloseTo(1, 9);
      expect(angleOf(turn)).toBeCloseTo(0.8, 6);
    }
  });

  it("are matched by id when some come and go", () => {
    const mixed = mix(state({ floaterId: 1, xM: 0 }, { floaterId: 2, xM: 1 }, { floaterId: 3, xM: 2 }, { floaterId: 4, xM: 3 }), state({ floaterId: 9, xM: 9 }, { floaterId: 1, xM: 1 }, { floaterId: 3, xM: 3 }, { floaterId: 4, xM: 4 }), 0.5);
    expect(mixed.map(({ floaterId, xM }) => [floaterId, xM])).toEqual([[1, 0.5], [2, 1], [3, 2.5], [4, 3.5]]);
  });

  it("jump, not glide, from one periodic side to the other", () => {
    expect(mix(state({ xM: 7.9 }), state({ xM: -7.9 }), 0.5)[0]!.xM).toBe(7.9);
    expect(mix(state({ zM: -5.9 }), state({ zM: 5.9 }), 0.5)[0]!.zM).toBe(-5.9);
    expect(mix(state({ xM: -3 }), state({ xM: 3 }), 0.5)[0]!.xM).toBe(0);
  });

  it("reuse the pose objects", () => {
    const poses: FloaterPose[] = [];
    const three = state({ floaterId: 1 }, { floaterId: 2 }, { floaterId: 3 });
    mixFloaters(three, three, 0, kWater, poses);
    const kept = [...poses];
    expect(mixFloaters(state(), state(), 0, kWater, poses)).toBe(0);
    mixFloaters(three, three, 0, kWater, poses);
    expect(poses.every((each, at) => each === kept[at])).toBe(true);
  });
});

describe("the object under a pointer", () => {
  const down = { originM: [0, 10, 0], direction: [0, -1, 0] } as const;
  const any = (): boolean => true;

  it("is the nearest one that the ray meets", () => {
    const deep = pose({ floaterId: 1, yM: -3 });
    const high = pose({ floaterId: 2, xM: 0.3, yM: 1 });
    expect(pickFloater(down, [deep, high], 0, any)?.floaterId).toBe(2);
    expect(pickFloater(down, [deep, high], 0, ({ yM }) => yM < 0)?.floaterId).toBe(1);
    expect(pickFloater({ ...down, direction: [0, 1, 0] }, [deep, high], 0, any)).toBeUndefined();
  });

  it("may be missed by as much as a finger covers, and a hit counts more than a near miss", () => {
    const aside = pose({ floaterId: 1, xM: 1, sizeM: 0.5 });
    expect(pickFloater(down, [aside], 0.05, any)).toBeUndefined();
    expect(pickFloater(down, [aside], Math.atan(1.01 / 10), any)?.floaterId).toBe(1);
    const deep = pose({ floaterId: 2, yM: -5 });
    for (const both of [[aside, deep], [deep, aside]]) expect(pickFloater(down, both, 0.2, any)?.floaterId).toBe(2);
  });
});

describe.each(kFloaterKinds)("the mesh of a %s", (kind) => {
  const geometries = [true, false].map((plain) => makeFloaterGeometry(kind, plain));

  it("is of size 1, inside of the sphere that pointers hit, and of few triangles", () => {
    for (const geometry of geometries) {
      geometry.computeBoundingBox();
      const { min, max } = geometry.boundingBox!;
      const longest = Math.max(max.x - min.x, max.y - min.y, max.z - min.z);
      expect(longest).toBeGreaterThan(0.9);
      expect(longest).toBeLessThan(1.12);
      const positions = geometry.getAttribute("position");
      for (let n = 0; n < positions.count; ++n) expect(Math.hypot(positions.getX(n), positions.getY(n), positions.getZ(n))).toBeLessThan(1.05 * kRadiusSizes[kind] + 0.01);
      expect(geometry.getIndex()!.count / 3).toBeLessThan(1700);
    }
  });

  it("shows its outside: faces look away from the middle, mostly, and normals have length 1", () => {
    for (const geometry of geometries) {
      const [positions, normals, index] = [geometry.getAttribute("position"), geometry.getAttribute("normal"), geometry.getIndex()!];
      let outwardVolume = 0;
      for (let t = 0; t < index.count; t += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => [positions.getX(index.getX(t + k)), positions.getY(index.getX(t + k)), positions.getZ(index.getX(t + k))]) as [number[], number[], number[]];
        outwardVolume += a[0]! * (b[1]! * c[2]! - b[2]! * c[1]!) + a[1]! * (b[2]! * c[0]! - b[0]! * c[2]!) + a[2]! * (b[0]! * c[1]! - b[1]! * c[0]!);
      }
      expect(outwardVolume / 6).toBeGreaterThan(0.01);
      for (let n = 0; n < normals.count; ++n) expect(Math.hypot(normals.getX(n), normals.getY(n), normals.getZ(n))).toBeCloseTo(1, 4);
    }
  });
});
