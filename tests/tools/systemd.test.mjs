// docker/systemd: the units and the configuration that they name.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { describe, it } from "node:test";

import { repository } from "./workshop.mjs";

const units = join(repository, "docker/systemd");

/** The directives of a unit: [section, key, value], in order. */
function directivesOf(file) {
  let section = "";
  const out = [];
  for (const line of readFileSync(join(units, file), "utf8").split("\n")) {
    if (line === "" || line.startsWith("#")) continue;
    const head = line.match(/^\[(\w+)\]$/);
    if (head) section = head[1];
    else out.push([section, ...line.match(/^(\w+)=(.*)$/).slice(1)]);
  }
  return out;
}

const valuesOf = (file, section, key) => directivesOf(file).flatMap(([s, k, value]) => (s === section && k === key ? [value] : []));
const service = (key) => valuesOf("spindrift.service", "Service", key);

describe("the service", () => {
  it("gives the program no rights that it does not need", () => {
    for (const [key, value] of [
      ["DynamicUser", "yes"],
      ["NoNewPrivileges", "yes"],
      ["CapabilityBoundingSet", ""],
      ["ProtectSystem", "strict"],
      ["ProtectHome", "yes"],
      ["PrivateTmp", "yes"],
      ["DevicePolicy", "closed"],
      ["RestrictAddressFamilies", "AF_INET AF_INET6 AF_UNIX"],
      ["SystemCallArchitectures", "native"],
    ]) {
      assert.deepEqual(service(key), [value], key);
    }
    assert.deepEqual(service("SystemCallFilter"), ["@system-service", "~@privileged"]);
  });

  it("leaves the program memory, devices, descriptors and time to stop", () => {
    assert.deepEqual(service("MemoryDenyWriteExecute"), ["no"]);
    assert.deepEqual(service("PrivateDevices"), ["no"]);
    assert.ok(service("DeviceAllow").includes("char-drm rw"));
    assert.ok(Number(service("LimitNOFILE")) >= 1024);
    assert.ok(Number(service("TimeoutStopSec")) >= 10);
  });

  it("does not wait for notifications, which the program does not send", () => {
    assert.deepEqual(service("Type"), ["exec"]);
    assert.deepEqual(service("WatchdogSec"), []);
  });

  it("starts the program with a configuration that it accepts and that keeps the rooms in the service's folder", () => {
    assert.deepEqual(service("ExecStart"), ["/opt/spindrift/spindrift serve --config /etc/spindrift/serve.textproto"]);
    const result = spawnSync(process.env.SPINDRIFT_BINARY, ["serve", "--config", join(units, "serve.textproto"), "--print-config"], { encoding: "utf8" });
    assert.equal(result.status, 0, result.stderr);
    assert.ok(result.stdout.includes(`state_dir: "/var/lib/${service("StateDirectory")[0]}"`), result.stdout);
  });
});

describe("the edge", () => {
  const edge = (key) => valuesOf("spindrift-edge.service", "Service", key);

  it("has no rights that the server does not have, and no devices", () => {
    for (const key of ["DynamicUser", "NoNewPrivileges", "CapabilityBoundingSet", "ProtectSystem", "ProtectHome", "RestrictAddressFamilies", "SystemCallFilter"]) {
      assert.deepEqual(edge(key), service(key), key);
    }
    assert.deepEqual(edge("PrivateDevices"), ["yes"]);
    assert.deepEqual(edge("MemoryDenyWriteExecute"), ["yes"]);
  });

  it("leaves the processors to simulations of the same machine", () => {
    assert.ok(Number(edge("Nice")) > Number(service("Nice")[0] ?? 0));
  });

  it("starts the program with a configuration that it accepts", () => {
    assert.deepEqual(edge("ExecStart"), ["/opt/spindrift/spindrift edge --config /etc/spindrift/edge.textproto --node edge-%l"]);
    const result = spawnSync(process.env.SPINDRIFT_BINARY, ["edge", "--config", join(units, "edge.textproto"), "--node", "edge-a", "--print-config"], { encoding: "utf8" });
    assert.equal(result.status, 0, result.stderr);
    assert.ok(result.stdout.includes("max_sessions: 1000  # file"), result.stdout);
  });
});

describe("the socket", () => {
  it("is one TCP port, which the server takes", () => {
    const sockets = directivesOf("spindrift.socket").filter(([section, key]) => section === "Socket" && key.startsWith("Listen"));
    assert.equal(sockets.length, 1);
    assert.match(sockets[0][2], /^(\S+:)?\d+$/);
    assert.deepEqual(valuesOf("spindrift.socket", "Socket", "Accept"), []);
  });
});

describe("the units", () => {
  const services = ["spindrift.service", "spindrift-edge.service"];
  const folder = () => {
    const path = mkdtempSync(join(tmpdir(), "spindrift-units-"));
    // The program is not installed on the machine that runs this test.
    for (const unit of services) {
      writeFileSync(join(path, unit), readFileSync(join(units, unit), "utf8").replace("/opt/spindrift/spindrift", "/bin/true"));
    }
    cpSync(join(units, "spindrift.socket"), join(path, "spindrift.socket"));
    return path;
  };

  it("are understood by systemd without a complaint", (context) => {
    if (spawnSync("systemd-analyze", ["--version"]).error) return context.skip("systemd-analyze is not installed");
    const path = folder();
    const args = ["verify", ...services.map((unit) => join(path, unit)), join(path, "spindrift.socket")];
    const result = spawnSync("systemd-analyze", args, { encoding: "utf8", env: { ...process.env, SYSTEMD_LOG_COLOR: "0" } });
    rmSync(path, { recursive: true });
    // systemd names unknown directives in a line with the file and ends with 0 all the same.
    assert.deepEqual(result.stderr.split("\n").filter((line) => line.includes(path)), []);
    assert.equal(result.status, 0, result.stderr);
  });

  it("expose little by systemd's own measure", (context) => {
    for (const unit of services) {
      const result = spawnSync("systemd-analyze", ["security", "--offline=yes", "--threshold=20", join(units, unit)], { encoding: "utf8" });
      if (result.error) return context.skip("systemd-analyze is not installed");
      assert.equal(result.status, 0, `${result.stdout}${result.stderr}`);
    }
  });
});
