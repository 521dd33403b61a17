import { readFileSync } from "node:fs";

/** Returns the version of the program; CMakeLists.txt is the only file that holds it. */
export function programVersion() {
  const text = readFileSync(new URL("../../CMakeLists.txt", import.meta.url), "utf8");
  const version = /^project\(spindrift VERSION ([0-9.]+)/m.exec(text)?.[1];
  if (version === undefined) throw new Error("CMakeLists.txt: project(spindrift VERSION ...) not found");
  return version;
}
