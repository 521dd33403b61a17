// Builds the image of docker/Dockerfile with buildah, without a Docker daemon and a registry, and runs its file system by the image's
// own user, entry point and health check. About ten minutes; needs root, buildah, debootstrap and a Debian mirror, else it is
// skipped. The images are made in a temporary folder (TMPDIR), or in SPINDRIFT_CONTAINERS_ROOT, where they stay: then the base
// images are made only once.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { existsSync, readFileSync, rmSync, statfsSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, before, describe, it } from "node:test";

import { Spec, Validation } from "@cyclonedx/cyclonedx-library";

import { repository } from "../tools/workshop.mjs";

const NEEDED_BYTES = 8 * 2 ** 30;
const BUILD_LIMIT_MS = 50 * 60_000;
const START_LIMIT_MS = 120_000;
const folder = process.env.SPINDRIFT_CONTAINERS_ROOT ?? join(tmpdir(), `spindrift-images-${process.pid}`);
const storage = ["--storage-driver", "vfs", "--root", join(folder, "storage"), "--runroot", join(folder, "run")];
const environment = { ...process.env, BUILDAH_ISOLATION: "chroot", SPINDRIFT_CONTAINERS_ROOT: folder };

function problem() {
  if (process.getuid() !== 0) return "buildah with chroot isolation and debootstrap need root";
  for (const tool of ["buildah", "debootstrap"]) if (spawnSync(tool, ["--version"]).error) return `${tool} is not installed (apt-get install buildah debootstrap)`;
  const { bavail, bsize } = statfsSync(tmpdir());
  if (bavail * bsize < NEEDED_BYTES) return `${tmpdir()} has less than ${NEEDED_BYTES / 2 ** 30} GiB free; TMPDIR names another place`;
  return undefined;
}

function buildah(...args) {
  const result = spawnSync("buildah", [...storage, ...args], { env: environment, encoding: "utf8", maxBuffer: 2 ** 26 });
  assert.equal(result.status, 0, `buildah ${args.join(" ")}: ${result.stderr}`);
  return result.stdout.trim();
}

async function freePort() {
  const server = createServer().listen(0, "127.0.0.1");
  await new Promise((resolve) => server.on("listening", resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

describe("the image", { skip: problem() }, () => {
  let container;
  let root;
  let config;
  let port;

  before(
    () => {
      const built = spawnSync(join(repository, "docker/build-with-buildah"), ["spindrift"], { env: environment, stdio: ["ignore", "inherit", "inherit"] });
      assert.equal(built.status, 0, "docker/build-with-buildah failed");
      container = buildah("from", "--pull-never", "spindrift");
      root = buildah("mount", container);
      config = JSON.parse(buildah("inspect", "--type", "image", "spindrift")).Docker.config;
    },
    { timeout: BUILD_LIMIT_MS },
  );
  after(() => {
    if (container) buildah("rm", container);
    if (!process.env.SPINDRIFT_CONTAINERS_ROOT) rmSync(folder, { recursive: true, force: true });
  });

  /** The command line that runs a program in the image as an engine does: its file system, its user without rights or capabilities,
   *  only its environment. The network is the machine's. */
  const inImage = (command, more = {}) => {
    const set = Object.entries({ ...Object.fromEntries(config.Env.map((entry) => entry.split(/=(.*)/s).slice(0, 2))), HOME: "/home/spindrift", ...more });
    const script =
      'mount --rbind /proc "$0/proc" && mount --rbind /sys "$0/sys" && mount --rbind /dev "$0/dev" && shift 0 && exec chroot "$0" setpriv "$@"';
    const user = readFileSync(join(root, "etc/passwd"), "utf8").match(new RegExp(`^${config.User}:[^:]*:(\\d+):(\\d+):`, "m"));
    return [
      "unshare", "--mount", "--propagation", "private", "sh", "-c", script, root,
      `--reuid=${user[1]}`, `--regid=${user[2]}`, "--clear-groups", "--no-new-privs", "--bounding-set=-all", "--inh-caps=-all",
      "env", "--ignore-environment", `--chdir=${config.WorkingDir}`, ...set.map(([key, value]) => `${key}=${value}`), ...command,
    ];
  };
  const run = (command, more) => {
    const [program, ...args] = inImage(command, more);
    return spawnSync(program, args, { encoding: "utf8", timeout: START_LIMIT_MS });
  };
  const healthcheck = () => run([...config.Healthcheck.Test.slice(1, -1), String(port)]);

  /** Starts the image's entry point and command; the state of its rooms is in the folder that a volume is for. */
  async function startServer() {
    const [program, ...args] = inImage([...config.Entrypoint, ...config.Cmd], {
      SPINDRIFT_PORT: String(port), SPINDRIFT_ADDRESS: "127.0.0.1", SPINDRIFT_STATE_DIR: "/var/lib/spindrift",
    });
    const server = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"] });
    let words = "";
    server.stderr.setEncoding("utf8").on("data", (text) => (words += text));
    const ended = new Promise((resolve) => server.on("exit", (code, signal) => resolve({ code, signal })));
    const timer = setTimeout(() => server.kill("SIGKILL"), START_LIMIT_MS);
    await new Promise((resolve, reject) => {
      createInterface({ input: server.stdout }).on("line", (line) => line.startsWith("Spindrift is ready: ") && resolve());
      ended.then((end) => reject(new Error(`the server ended: ${JSON.stringify(end)}\n${words}`)));
    });
    clearTimeout(timer);
    return {
      words: () => words,
      processId: server.pid,
      async stop() {
        const begin = Date.now();
        server.kill("SIGTERM");
        return { end: await ended, seconds: (Date.now() - begin) / 1000 };
      },
    };
  }

  const roomTick = async () => {
    const response = await fetch(`http://127.0.0.1:${port}/metrics`);
    return Number((await response.text()).match(/^spindrift_room_ticks_total\{[^}]*\} (\d+)/m)?.[1]);
  };

  it("runs as a user without rights, with a health check and an entry point", () => {
    assert.equal(config.User, "spindrift");
    assert.deepEqual(config.Entrypoint, ["/opt/spindrift/spindrift"]);
    assert.deepEqual(config.Cmd, ["serve"]);
    assert.deepEqual(config.Healthcheck.Test, ["CMD", "/opt/spindrift/healthcheck", "8080"]);
    const [uid, groups] = run(["sh", "-c", "id -u; id -G; ! touch /opt/spindrift/x 2>/dev/null || echo writable"]).stdout.split("\n");
    assert.deepEqual([uid, groups], ["10001", "10001"]);
    assert.equal(run(["touch", "/opt/spindrift/x"]).status, 1, "the program's folder is writable");
  });

  it("has neither compilers, sources nor the certificates of the machine that built it", () => {
    for (const path of ["usr/bin/g++", "usr/bin/node", "usr/bin/python3", "src", "usr/local/share/ca-bundle.crt"]) assert.ok(!existsSync(join(root, path)), path);
    assert.ok(config.Env.every((entry) => !/NODE_EXTRA_CA_CERTS|proxy/i.test(entry)), config.Env.join(" "));
  });

  it("finds the software rasteriser", () => {
    const info = run([...config.Entrypoint, "info"]);
    assert.equal(info.status, 0, info.stderr);
    assert.match(info.stdout, /llvmpipe/);
  });

  it("serves frames, ends with code 0 at SIGTERM and resumes", { timeout: 4 * START_LIMIT_MS }, async (context) => {
    port = await freePort();
    writeFileSync(join(root, "tmp/splash.textproto"), readFileSync(join(repository, "tests/containers/splash.textproto")), { mode: 0o644 });
    assert.equal(healthcheck().status, 1, "healthy without a server");

    const first = await startServer();
    assert.match(readFileSync(`/proc/${first.processId}/status`, "utf8"), /^Uid:\t10001\t10001\t10001\t10001$/m);
    assert.match(readFileSync(`/proc/${first.processId}/status`, "utf8"), /^CapEff:\t0+$/m);
    assert.equal(healthcheck().status, 0, first.words());
    const page = await fetch(`http://127.0.0.1:${port}/`);
    assert.match(await page.text(), /<script/);
    const script = run([...config.Entrypoint, "script", "--url", `ws://127.0.0.1:${port}`, "/tmp/splash.textproto"]);
    assert.equal(script.status, 0, script.stdout + script.stderr);
    const tick = await roomTick();
    const ended = await first.stop();
    assert.deepEqual(ended.end, { code: 0, signal: null }, first.words());
    assert.ok(ended.seconds <= 5, `it took ${ended.seconds} s to end`);
    const files = spawnSync("find", [join(root, "var/lib/spindrift"), "-type", "f", "-printf", "%P %s %U\n"], { encoding: "utf8" }).stdout.trim();
    assert.match(files, /rooms\/main\/.*snapshot/, files);

    const second = await startServer();
    try {
      const again = run([...config.Entrypoint, "script", "--url", `ws://127.0.0.1:${port}`, "/tmp/splash.textproto"]);
      assert.equal(again.status, 0, again.stdout + again.stderr);
      assert.match(second.words(), /room main: continues at tick \d+ of scene/);
    } finally {
      assert.deepEqual((await second.stop()).end, { code: 0, signal: null }, second.words());
    }
    context.diagnostic(`stopped ${tick} ticks after the start within ${ended.seconds.toFixed(2)} s; state on disk: ${files.replaceAll("\n", ", ")}`);
  });

  it("lists what it consists of, with a licence each, in a form that is valid CycloneDX", async (context) => {
    const made = spawnSync("python3", [join(repository, ".ci/lib/sbom.py"), "image", "--root", root], { encoding: "utf8", maxBuffer: 2 ** 26 });
    assert.equal(made.status, 0, made.stderr);
    assert.equal(await new Validation.JsonStrictValidator(Spec.Version.v1dot5).validate(made.stdout), null);
    const { components } = JSON.parse(made.stdout);
    const names = new Set(components.map((component) => component["bom-ref"]));
    for (const name of ["deb:libegl-mesa0", "deb:libllvm15", "deb:libc6", "bundle/npm:three", "bundle/deb:libprotobuf32"]) assert.ok(names.has(name), name);
    const installed = readFileSync(join(root, "var/lib/dpkg/status"), "utf8").match(/^Status: install ok installed$/gm).length;
    assert.equal([...names].filter((name) => name.startsWith("deb:")).length, installed);
    const unknown = components.filter((component) => component.licenses.some((entry) => entry.license?.name?.startsWith("see ")));
    const bytes = spawnSync("du", ["--summarize", "--block-size=1", root], { encoding: "utf8" }).stdout.split("\t")[0];
    const bundled = spawnSync("du", ["--summarize", "--block-size=1", join(root, "opt/spindrift")], { encoding: "utf8" }).stdout.split("\t")[0];
    context.diagnostic(`image: ${(bytes / 1e6).toFixed(0)} MB on disk, ${(bundled / 1e6).toFixed(0)} MB of it Spindrift`);
    context.diagnostic(`${components.length} parts; without a licence that a program can read: ${unknown.map((component) => component.name).join(" ") || "none"}`);
    if (process.env.SPINDRIFT_SBOM) writeFileSync(process.env.SPINDRIFT_SBOM, made.stdout);
  });
});
