// scene_types.py, with which the build makes core::Scene. tests/unit/scene/scene_defaults_test.cpp tests what it makes.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, describe, it } from "node:test";

import { repository } from "./workshop.mjs";

describe("scene_types.py", () => {
  const folder = mkdtempSync(join(tmpdir(), "spindrift scene types "));
  const proto = readFileSync(join(repository, "proto/spindrift/v1/scene.proto"), "utf8");
  const make = (text) => {
    writeFileSync(join(folder, "scene.proto"), text);
    const command = [join(repository, "server/core/scene_types.py"), "structs", join(folder, "scene.proto"), join(folder, "out.h")];
    const { status, stderr } = spawnSync("python3", command, { encoding: "utf8" });
    return { status, stderr, header: status === 0 ? readFileSync(join(folder, "out.h"), "utf8") : "" };
  };
  after(() => rmSync(folder, { recursive: true }));

  it("makes a member with comment, unit and default of a line", () => {
    const line = '  optional double tint_ratio = 99 [(parameter) = {label: "Tint" unit: "" min: 0 max: 1 step: 0.1 default: 1 help: "Colour of foam."}];';
    const { status, stderr, header } = make(proto.replace("message FoamScene {\n", `message FoamScene {\n${line}  // thin foam\n`));
    assert.equal(status, 0, stderr);
    assert.match(header, /struct FoamScene \{\n {2}\/\/\/ Colour of foam\. \[0 to 1\] thin foam\n {2}double tint_ratio = 1\.0;\n/);
  });

  it("refuses what it cannot read, with the line", () => {
    const line = proto.slice(0, proto.indexOf("message FoamScene {")).split("\n").length + 1;
    const refused = (inserted) => make(proto.replace("message FoamScene {\n", `message FoamScene {\n${inserted}\n`));
    assert.match(refused("  map<string, double> tints = 99;").stderr, new RegExp(`scene.proto: line ${line}: in no form that scene_types.py reads`));
    assert.match(refused('  optional double tint_ratio = 99 [(parameter) = {label: "Tint"}];').stderr, new RegExp(`line ${line}: a parameter has label`));
    assert.match(refused("  Tint tint = 99;").stderr, /Tint is a type that scene_types.py does not know/);
    assert.match(make(proto.replace("Unwatched unwatched = 20", "Unwatched idle = 20")).stderr, /names Scene\.unwatched, which scene\.proto does not have/);
  });
});
