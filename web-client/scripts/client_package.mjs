// Completes the npm package of the client in client/dist, beside what `npm run build:client` has built: package.json with the program's version,
// which CMakeLists.txt holds, and the version of the library that the messages were generated for, the license, and the extensions
// that Node's resolution wants in declarations.
import { copyFileSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

import { programVersion } from "./program_version.mjs";

const root = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
const dist = path.join(root, "client/dist");
const { dependencies: ofThePage } = JSON.parse(readFileSync(path.join(root, "package.json"), "utf8"));
const { name, dependencies, ...others } = JSON.parse(readFileSync(path.join(root, "client/package.json"), "utf8"));
const complete = { name, version: programVersion(), ...others, dependencies: { "@bufbuild/protobuf": `^${ofThePage["@bufbuild/protobuf"]}`, ...dependencies } };
writeFileSync(path.join(dist, "package.json"), `${JSON.stringify(complete, null, 2)}\n`);
copyFileSync(path.join(root, "../LICENSE"), path.join(dist, "LICENSE"));
for (const file of readdirSync(path.join(dist, "types"), { recursive: true, encoding: "utf8" }).filter((each) => each.endsWith(".d.ts"))) {
  const at = path.join(dist, "types", file);
  writeFileSync(at, readFileSync(at, "utf8").replace(/((?:from|import)(?: |\()")(\.{1,2}\/[^"]+?)(?<!\.js)"/g, '$1$2.js"'));
}
