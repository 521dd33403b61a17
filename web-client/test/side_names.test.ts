import { describe, expect, it } from "vitest";

import type { SideKind, SideName, WaveInfo } from "../client/codec/scene_info";
import { sidesOf } from "../src/ui/side_names";
import { kTexts } from "../src/ui/texts";

const wave = (sides: Record<SideName, SideKind>): WaveInfo => ({ sides }) as WaveInfo;
const named = (...surrounded: Parameters<typeof sidesOf>): string[] => sidesOf(...surrounded).map(({ what, where }) => kTexts.side(what, where));

describe("names of the sides of the water", () => {
  it("say what is there, and where only if there are several", () => {
    const sides = { "+x": "closed", "-x": "open", "+z": "closed", "-z": "open" } as const;
    const beaches = [{ side: "+x", widthM: 6, shoreDepthM: 0 }] as const;
    expect(named({ wave: wave(sides), beaches: [...beaches], setting: "openSea" })).toEqual(["beach", "left side: open sea", "rocky shore", "far side: open sea"]);
    expect(named({ wave: wave(sides), beaches: [], setting: "openSea" })[0]).toBe("right side: quay");
  });

  it("are walls in a basin, and ends where a flume lets waves out", () => {
    const sides = { "+x": "open", "-x": "closed", "+z": "closed", "-z": "closed" } as const;
    expect(named({ wave: wave(sides), beaches: [], setting: "flume" })).toEqual(["open end", "left side: wall", "near side: wall", "far side: wall"]);
    expect(named({ wave: undefined, beaches: [], setting: "glassTank" })[0]).toBe("right side: wall");
  });

  it("follow the direction in which the scene is seen first", () => {
    const firstView = { xM: 0, zM: 0, acrossM: 0, awayM: 0, headingRad: (170 * Math.PI) / 180, pitchRad: 0.3, hour: 12, subjectRightM: 0 };
    expect(named({ wave: undefined, beaches: [], setting: "pool", firstView })).toEqual(["near side: wall", "far side: wall", "left side: wall", "right side: wall"]);
  });
});
