// The npm package spindrift-client as its users have it: packed, and installed into a folder of its own.
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { repository, temporaryFolder } from "../browser/server.mjs";

export const kClientDist = join(repository, "web-client/client/dist");

/** Runs npm; returns what it prints. */
export function npm(folder, ...command) {
  const { status, stdout, stderr } = spawnSync("npm", command, { cwd: folder, encoding: "utf8" });
  if (status !== 0) throw new Error(`npm ${command.join(" ")}: ${stderr}`);
  return stdout.trim();
}

/** Makes a temporary folder with a project that has the package, and what spindrift-mcp needs besides if `withAgent`; returns its path. The
 *  caller removes it. */
export function installClient({ withAgent = false } = {}) {
  const folder = temporaryFolder("client");
  writeFileSync(join(folder, "package.json"), '{ "private": true, "type": "module" }');
  const tarball = npm(folder, "pack", kClientDist, "--silent");
  npm(folder, "install", "--prefer-offline", "--no-audit", "--no-fund", `./${tarball}`, ...(withAgent ? agentPackages() : []));
  return folder;
}

/** The optional packages, in the versions that the client is built with. */
function agentPackages() {
  const { peerDependencies } = JSON.parse(readFileSync(join(kClientDist, "package.json"), "utf8"));
  const { devDependencies } = JSON.parse(readFileSync(join(repository, "web-client/package.json"), "utf8"));
  return Object.keys(peerDependencies).map((name) => `${name}@${devDependencies[name]}`);
}
