// The clients of the README, as they stand there: its curl command, and its program with the package installed.
import { spawn, spawnSync } from "node:child_process";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { repository, startServer } from "../browser/server.mjs";
import { installClient } from "./installed_client.mjs";

const kMaxLineCount = 10;

const readme = readFileSync(join(repository, "README.md"), "utf8");
const curl = /^ {4}(curl .*\/commands)$/m.exec(readme)?.[1] ?? "";
const program = /^```js\n(.*?)^```$/ms.exec(readme)?.[1] ?? "";

let server;
let folder;
beforeAll(async () => {
  server = await startServer();
  folder = installClient();
});
afterAll(async () => {
  if (folder) rmSync(folder, { recursive: true, force: true });
  await server?.stop("SIGTERM");
});

const atServer = (text) => text.replaceAll("127.0.0.1:8080", `127.0.0.1:${server.port}`);

describe("the client of the README", () => {
  it(`has at most ${kMaxLineCount} lines`, () => {
    expect(curl).not.toBe("");
    expect(program).not.toBe("");
    expect(1 + program.trimEnd().split("\n").length).toBeLessThanOrEqual(kMaxLineCount);
  });

  it("splashes with curl and prints heights that follow", async () => {
    writeFileSync(join(folder, "watch.mjs"), atServer(program));
    const child = spawn(process.execPath, ["watch.mjs"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
    try {
      const heights = readHeights(child.stdout);
      expect((await heights.next()).value.height_m).toBeLessThan(10);
      const made = spawnSync("bash", ["-c", atServer(curl)], { encoding: "utf8" });
      expect(made.status, made.stderr).toBe(0);
      const applied_tick = Number(JSON.parse(made.stdout).ack.applied_tick);
      for await (const { tick, height_m } of heights) {
        if (tick > applied_tick && height_m > 0.05) break;
      }
    } finally {
      child.kill();
    }
  });
});

/** The lines of the program's output as {tick, height_m}. */
async function* readHeights(stream) {
  let rest = "";
  for await (const chunk of stream.setEncoding("utf8")) {
    const lines = (rest + chunk).split("\n");
    rest = lines.pop();
    for (const line of lines) {
      const match = /^tick (\d+): up to (-?[\d.e-]+) m$/.exec(line);
      if (!match) throw new Error(`unexpected line: ${line}`);
      yield { tick: Number(match[1]), height_m: Number(match[2]) };
    }
  }
}
