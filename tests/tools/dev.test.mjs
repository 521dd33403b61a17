import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { afterEach, beforeEach, describe, it } from "node:test";

import { repository, Workshop } from "./workshop.mjs";

const COMMANDS = ["run", "test", "build", "bench", "study", "charts", "gallery", "fuzz", "fmt", "lint", "bundle", "clean"];

describe("./dev", () => {
  let shop;
  beforeEach(() => {
    shop = new Workshop();
  });
  afterEach(() => shop.remove());

  it("prints the help of every command without calling a tool", () => {
    const overview = shop.dev(["--help"]);
    assert.equal(overview.code, 0);
    for (const command of COMMANDS) {
      assert.match(overview.stdout, new RegExp(`^  ${command} `, "m"));
      const help = shop.dev([command, "--help"]);
      assert.equal(help.code, 0, help.stderr);
      assert.match(help.stdout, new RegExp(`^usage: ./dev ${command}`));
      assert.deepEqual(help.calls, []);
    }
  });

  it("refuses unknown commands, parts, options and presets with one line and exit code 2", () => {
    for (const args of [["swim"], ["test", "everything"], ["build", "--fast"], ["run", "--preset", "quick"], ["clean", "x"], ["fmt", "-x"], ["bundle", "-x"], ["fuzz", "water"], ["charts"], ["charts", "a", "b"], ["gallery", "harbor"]]) {
      const refused = shop.dev(args);
      assert.equal(refused.code, 2, args.join(" "));
      assert.match(refused.stderr, /^dev: .*\n$/, args.join(" "));
      assert.equal(refused.stdout, "");
    }
  });

  it("installs missing packages once, prints the reason, and does not call apt again", () => {
    shop.missing("ninja-build libspdlog-dev libgl1-mesa-dri");
    const first = shop.dev(["build"]);
    assert.equal(first.code, 0, first.stderr);
    assert.match(first.stderr, /installing for building the server and its tests: ninja-build libspdlog-dev\n/);
    assert.match(first.stderr, /installing for OpenGL without a GPU .*: libgl1-mesa-dri\n/);
    const apt = first.calls.filter((call) => call.startsWith("apt-get"));
    assert.equal(apt.length, 2);
    assert.match(apt[0], /^apt-get update/);
    assert.match(apt[1], /^apt-get install .*--no-install-recommends ninja-build libspdlog-dev libgl1-mesa-dri$/);

    assert.deepEqual(shop.dev(["build"]).calls.filter((call) => call.startsWith("apt-get")), []);
  });

  it("uses sudo when it is not root, without a prompt where there is no terminal", (t) => {
    shop.missing("ninja-build");
    const prefix = process.getuid() === 0 ? ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--"] : [];
    spawnSync("chmod", ["-R", "a+rwX", shop.folder]);
    if (prefix.length > 0 && spawnSync(prefix[0], [...prefix.slice(1), "true"]).status !== 0) {
      t.skip("cannot become another user here");
      return;
    }
    const built = shop.dev(["build"], { prefix });
    assert.equal(built.code, 0, built.stderr);
    assert.equal(built.calls[0], "sudo --non-interactive");
    assert.match(built.calls[1], /^apt-get update/);
  });

  it("builds the second time without configuring, fetching or bundling again", () => {
    const first = shop.dev(["build"]).calls;
    assert.deepEqual(first.map((call) => call.split(" ").slice(0, 2).join(" ")), ["cmake --preset", "cmake --build", "npm ci", "npm run"]);
    assert.deepEqual(shop.dev(["build"]).calls.map((call) => call.split(" ")[0]), ["cmake"]);
  });

  it("builds the page again when a source, the wire or a library changed", () => {
    shop.dev(["build"]);
    shop.write("web-client/src/main.ts", "second");
    assert.equal(shop.dev(["build"]).calls.filter((call) => call.startsWith("npm run")).length, 1);
    shop.write("proto/wire.proto", "second");
    assert.equal(shop.dev(["build"]).calls.filter((call) => call.startsWith("npm run")).length, 1);
    shop.write("web-client/package-lock.json", '{"second": true}');
    assert.deepEqual(shop.dev(["build"]).calls.filter((call) => call.startsWith("npm")).map((call) => call.split(" ")[1]), ["ci", "run"]);
  });

  it("passes every argument and the calling folder to the server", () => {
    const run = shop.dev(["run", "--preset", "debug", "--port", "9000", "--scene", "my scene.textproto"], { cwd: shop.folder });
    assert.equal(run.code, 0, run.stderr);
    assert.equal(run.stdout, `${shop.folder}\n<serve><--port><9000><--scene><my scene.textproto>`);
    assert.ok(run.calls.includes("cmake --preset debug"));
  });

  it("installs a private Node once if the machine's is too old", () => {
    shop.useNode("v18.20.4");
    const first = shop.dev(["build"]);
    assert.equal(first.code, 0, first.stderr);
    assert.match(first.stderr, /Node v18\.20\.4 is too old/);
    assert.equal(first.calls.filter((call) => call.includes("build/tools/node")).length, 1);
    assert.ok(existsSync(join(shop.checkout, "build/tools/node/complete")));
    assert.equal(shop.dev(["build"]).calls.filter((call) => call.startsWith("npm")).length, 0);
  });

  it("uses the Node that it has just installed, where that is new enough", () => {
    const script = `source "$1"; PATH=/nowhere
      need_packages() { npm() { :; }; node() { echo v20.19.2; }; }
      step() { echo "fetches another one"; }
      need_node && echo ready`;
    const result = spawnSync("bash", ["-c", script, "bash", join(repository, ".ci/lib/node.sh")], { encoding: "utf8" });
    assert.equal(result.stdout, "ready\n", result.stderr);
  });

  it("accepts the Node versions that Vite supports and no others", () => {
    const accepts = (version) =>
      spawnSync("bash", ["-c", 'source "$1"; node_is_new_enough "$2"', "bash", join(repository, ".ci/lib/node.sh"), version]).status === 0;
    for (const version of ["v20.19.0", "v20.20.2", "v22.12.0", "v24.0.0", "v26.1.0"]) assert.ok(accepts(version), version);
    for (const version of ["v18.20.4", "v20.18.3", "v21.7.3", "v22.11.0", "v23.3.0", "", "nonsense"]) assert.ok(!accepts(version), version);
  });

  it("installs a browser for pictures, and for films what encodes them", () => {
    shop.missing("chromium ffmpeg");
    const pictures = shop.dev(["gallery", "--scenes", "harbor"]);
    assert.equal(pictures.code, 0, pictures.stderr);
    assert.match(pictures.calls.join("\n"), /^apt-get install .*--no-install-recommends chromium$/m);
    assert.ok(pictures.calls.includes("npm ci --prefix tests/browser --no-fund --no-audit"), pictures.calls.join("\n"));
    shop.missing("ffmpeg");
    const film = shop.dev(["gallery", "tour", "--qualities", "low"]);
    assert.equal(film.code, 0, film.stderr);
    assert.match(film.calls.join("\n"), /^apt-get install .*--no-install-recommends ffmpeg$/m);
  });

  it("shows the end of the log and its path when a step fails", () => {
    shop.breakCompiler();
    const failed = shop.dev(["run"]);
    assert.equal(failed.code, 1);
    assert.equal(failed.stdout, "");
    assert.match(failed.stderr, /error: something does not compile\nthe whole log: build\/logs\/build-release\.log\ndev: step 'build-release' failed/);
  });

  it("ends ./dev test with a failing total when the build fails", () => {
    shop.breakCompiler();
    const failed = shop.dev(["test", "unit"]);
    assert.equal(failed.code, 1);
    assert.equal(failed.stdout, "0 passed, 1 failed, 0 skipped\n");
  });

  it("removes what it built, and what it downloaded only with --all", () => {
    shop.useNode("v18.20.4");
    shop.dev(["build"]);
    shop.dev(["clean"]);
    assert.ok(!existsSync(join(shop.checkout, "build/release")));
    assert.ok(!existsSync(join(shop.checkout, "web-client/dist")));
    assert.ok(existsSync(join(shop.checkout, "build/tools/node/complete")));
    shop.dev(["clean", "--all"]);
    assert.ok(!existsSync(join(shop.checkout, "build")));
    assert.ok(!existsSync(join(shop.checkout, "web-client/node_modules")));
  });

  it("is clean under shellcheck", (t) => {
    if (spawnSync("shellcheck", ["--version"]).status !== 0) {
      t.skip("shellcheck is missing");
      return;
    }
    const files = ["dev", ".ci/run", ".ci/bundle/spindrift", "docker/healthcheck", "docker/install-runtime", "docker/build-with-buildah"];
    const checked = spawnSync("shellcheck", ["--external-sources", "--check-sourced", ...files], { cwd: repository, encoding: "utf8" });
    assert.equal(checked.status, 0, checked.stdout);
  });
});
