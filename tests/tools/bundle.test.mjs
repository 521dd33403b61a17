// Runs the bundle in a root folder with only the C library, a shell and five small tools: no driver, no C++ runtime, no other
// Spindrift. So it also runs on a bare machine.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, realpathSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { after, before, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

const { Spec, Validation } = createRequire(join(repository, "tests/containers/package.json"))("@cyclonedx/cyclonedx-library");
const TOOLS = ["/bin/sh", "/usr/bin/readlink", "/usr/bin/dirname", "/usr/bin/basename", "/usr/bin/sed", "/usr/bin/head"];
/** The whole environment. */
const TOOL_PATH = { PATH: "/usr/sbin:/usr/bin:/sbin:/bin" };
const START_LIMIT_MS = 120_000;

const lines = (text) => text.split("\n").filter((line) => line !== "");

/** Every file that the loader opens for a program, the loader included. */
function loaded(program) {
  const { stdout } = spawnSync("ldd", [program], { encoding: "utf8" });
  return [...stdout.matchAll(/(?:=> )?(\/\S+) \(0x/g)].map((match) => match[1]);
}

function install(root, path) {
  mkdirSync(join(root, dirname(path)), { recursive: true });
  cpSync(realpathSync(path), join(root, path));
}

describe("the bundle", () => {
  let folder;
  let bundle;
  let root;
  /** Returns the command line that starts a program inside `root`, or undefined if this machine forbids it. */
  let enter;

  before(
    () => {
      folder = mkdtempSync(join(tmpdir(), "spindrift bundle "));
      const made = spawnSync(join(repository, "dev"), ["bundle", "--with-tests", "--no-archive", "--output", folder], { encoding: "utf8" });
      assert.equal(made.status, 0, made.stderr);
      bundle = join(folder, readdirSync(folder).find((name) => name.startsWith("spindrift-")));

      root = join(folder, "root");
      for (const tool of TOOLS) for (const path of [tool, ...loaded(tool)]) install(root, path);
      // Parts of the C library, which the bundle takes from the machine.
      const libc = loaded("/bin/sh").find((path) => basename(path) === "libc.so.6");
      for (const name of ["libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "libresolv.so.2"]) install(root, join(dirname(libc), name));
      for (const name of ["dev", "proc", "tmp"]) mkdirSync(join(root, name));
      writeFileSync(join(root, "dev/null"), "");
      cpSync(bundle, join(root, "opt/a bundle"), { recursive: true, verbatimSymlinks: true });

      // Every Linux has /proc; a separate mount namespace removes it at the end.
      const script = 'mount --rbind /proc "$0/proc" && exec chroot "$0" "$@"';
      const ways = [["--mount"], ["--user", "--map-root-user", "--mount"]].map((options) => ["/usr/bin/unshare", ...options, "/bin/sh", "-c", script, root]);
      enter = ways.find((way) => spawnSync(way[0], [...way.slice(1), "/bin/sh", "-c", "exit 0"], { env: TOOL_PATH }).status === 0);
    },
    { timeout: 600_000 },
  );
  after(() => rmSync(folder, { recursive: true, force: true }));

  /** Returns the command line that starts the launcher in the bare root. Signals reach the server, because each step is an exec. */
  const inRoot = (...args) => [...enter, "/opt/a bundle/spindrift", ...args];

  it("finds every library in the bundle, except those of the C library", () => {
    const { stdout } = spawnSync("ldd", [join(bundle, "bin/spindrift")], { encoding: "utf8" });
    assert.doesNotMatch(stdout, /not found/);
    const own = new Set(readdirSync(join(bundle, "lib")).concat(readdirSync(join(bundle, "lib/fallback"))));
    assert.match(stdout, /libprotobuf/);
    for (const line of lines(stdout)) {
      const name = line.trim().split(" ")[0];
      const is_of_the_system = /^(linux-vdso|\/lib64\/ld-linux|ld-linux|lib(c|m|dl|pthread|rt|resolv)\.so)/.test(name);
      assert.ok(is_of_the_system || own.has(name), `${name} is not in the bundle`);
    }
  });

  it("has a licence for itself and for every bundled part", () => {
    assert.ok(existsSync(join(bundle, "LICENSE")));
    const licences = readdirSync(join(bundle, "share/licenses")).join(" ");
    for (const part of ["libprotobuf", "libegl-mesa0", "libgl1-mesa-dri", "libllvm", "three", "libboost", "libcli11"]) assert.ok(licences.includes(part), part);
  });

  it("lists its parts with versions and licences: libraries, compiled headers, the page's packages", async () => {
    const text = readFileSync(join(bundle, "share/sbom.cdx.json"), "utf8");
    assert.equal(await new Validation.JsonStrictValidator(Spec.Version.v1dot5).validate(text), null, "no valid CycloneDX");
    const { metadata, components } = JSON.parse(text);
    assert.deepEqual(metadata.component.licenses, [{ license: { id: "MIT" } }]);
    const licencesOf = (name) => components.find((component) => component["bom-ref"] === name)?.licenses;
    assert.deepEqual(licencesOf("npm:three"), [{ expression: "MIT" }]);
    assert.deepEqual(licencesOf("deb:libcli11-dev"), [{ license: { id: "BSD-3-Clause" } }]);
    assert.deepEqual(licencesOf("deb:libstdc++6"), [{ license: { name: "GPL-3.0-or-later WITH GCC-exception-3.1" } }]);
    assert.ok(licencesOf("deb:libgl1-mesa-dri"), "Mesa is missing");
    for (const component of components) {
      assert.ok(component.version && component.licenses.length > 0, component["bom-ref"]);
      const file = component.name.replace("@", "").replace("/", "-");
      assert.ok(existsSync(join(bundle, "share/licenses", `${file}.txt`)), `${file} has no licence text`);
    }
    // Each bundled library belongs to a package that is listed.
    const packages = spawnSync("dpkg-query", ["--search", "*/libprotobuf.so.32", "*/libspdlog.so.1.10"], { encoding: "utf8" }).stdout;
    for (const line of lines(packages)) assert.ok(licencesOf(`deb:${line.split(":")[0]}`), line);
  });

  it("runs with only PATH in the environment", () => {
    const info = spawnSync(join(bundle, "spindrift"), ["info"], { env: TOOL_PATH, encoding: "utf8", timeout: START_LIMIT_MS });
    assert.equal(info.status, 0, info.stderr);
  });

  it("is measured by on-hardware.sh, which joins what its parts wrote", () => {
    const script = join(repository, "tests/bench/on-hardware.sh");
    const output = join(folder, "results");
    const measure = (...args) => spawnSync(script, [bundle, "--device", "software", "--output", output, ...args], { encoding: "utf8", timeout: 2 * START_LIMIT_MS, env: { ...process.env, SPINDRIFT_HASH_TICKS: "10" } });
    const run = measure("--parts", "info,hash,codec");
    assert.equal(run.status, 0, run.stdout + run.stderr);
    const [name] = readdirSync(output).filter((file) => file.endsWith(".json"));
    const { device, failed, parts } = JSON.parse(readFileSync(join(output, name), "utf8"));
    assert.match(device, /llvmpipe/);
    assert.deepEqual(failed, []);
    assert.ok(parts["codec-thesis"].codec.rows.length > 0);
    assert.ok(existsSync(join(bundle, "bin/sim_test")), "tests of the device");
    assert.match(measure("--parts", "all").stderr, /there is no part 'all'/);
  });

  it("uses its own software rasteriser on a machine without a driver", (t) => {
    if (!enter) return t.skip("this machine allows neither chroot nor user namespaces");
    const [command, ...args] = inRoot("info", "--json", "-");
    const info = spawnSync(command, args, { env: TOOL_PATH, encoding: "utf8", timeout: START_LIMIT_MS });
    assert.equal(info.status, 0, info.stderr);
    assert.match(JSON.stringify(JSON.parse(info.stdout)), /llvmpipe/);
  });

  it("serves its own page and default scene there, and ends on a signal", { timeout: 2 * START_LIMIT_MS }, async (t) => {
    if (!enter) return t.skip("this machine allows neither chroot nor user namespaces");
    const [command, ...args] = inRoot("serve", "--port", "0");
    const server = spawn(command, args, { env: TOOL_PATH, stdio: ["ignore", "pipe", "pipe"] });
    let words = "";
    server.stderr.setEncoding("utf8").on("data", (text) => (words += text));
    const ended = new Promise((resolve) => server.on("exit", (code, signal) => resolve({ code, signal })));
    const timer = setTimeout(() => server.kill("SIGKILL"), START_LIMIT_MS);
    try {
      const url = await new Promise((resolve, reject) => {
        createInterface({ input: server.stdout }).on("line", (line) => {
          const match = /^Spindrift is ready: (http:\S+)/.exec(line);
          if (match) resolve(match[1]);
        });
        ended.then((end) => reject(new Error(`the server ended: ${JSON.stringify(end)}\n${words}`)));
      });
      const page = await fetch(url);
      assert.equal(page.status, 200);
      assert.match(await page.text(), /<script/);
    } finally {
      server.kill("SIGTERM");
      await ended;
      clearTimeout(timer);
    }
    assert.deepEqual(await ended, { code: 0, signal: null }, words);
  });
});
