import { describe, expect, it } from "vitest";

import { fileName } from "../src/app/saved_file";

describe("the name of a saved picture or film", () => {
  const at = new Date(2026, 10, 7, 9, 3, 5);

  it("has the scene and the local time", () => {
    expect(fileName("dam_break", "png", at)).toBe("spindrift-dam-break-2026-11-07-090305.png");
  });

  it("has only characters that every file system takes", () => {
    expect(fileName("../Häfen & more?", "mp4", at)).toBe("spindrift-h-fen-more-2026-11-07-090305.mp4");
    expect(fileName("…", "webm", at)).toBe("spindrift-water-2026-11-07-090305.webm");
  });
});
