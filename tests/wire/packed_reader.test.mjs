// Reads the golden bytes with a program that was written from proto/README.md alone.
import { spawnSync } from "node:child_process";
import { cpSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { repository, temporaryFolder } from "../browser/server.mjs";

const kGolden = join(repository, "tests/golden");

function read(folder) {
  return spawnSync("python3", ["-B", join(import.meta.dirname, "packed_reader.py"), folder], { encoding: "utf8" });
}

describe("a reader written from the README alone", () => {
  it("makes of every golden file what golden.json says, and refuses the others", () => {
    const { status, stdout, stderr } = read(kGolden);
    expect(stderr).toBe("");
    expect(stdout).toMatch(/^\d+ cases \(\d+ bad_frame, \d+ bad_message, \d+ ok\), 0 differ\n$/);
    expect(status).toBe(0);
  });

  it("tells where a file and its expectation differ", () => {
    const folder = temporaryFolder("golden");
    try {
      cpSync(kGolden, folder, { recursive: true });
      const cases = JSON.parse(readFileSync(join(folder, "golden.json"), "utf8"));
      cases.find((one) => one.file === "particles_packed.bin").velocity_mps[5] += 0.01;
      cases.find((one) => one.file === "foam_packed_1.bin").foam[143] ^= 1;
      cases.find((one) => one.file === "bad_surface_crc.bin").verdict = "ok";
      writeFileSync(join(folder, "golden.json"), JSON.stringify(cases));
      const { status, stdout } = read(folder);
      expect(status).toBe(1);
      for (const line of [/^particles_packed.bin: velocity_mps: \[5\]/m, /^foam_packed_1.bin: foam: \[143\]/m, /^bad_surface_crc.bin: refused: the checksum/m, / 3 differ$/m])
        expect(stdout).toMatch(line);
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
});
