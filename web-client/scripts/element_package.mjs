// Completes the npm package of the web component in element/dist, beside what `npm run build:element` has built: package.json with the
// program's version, which CMakeLists.txt holds, the license and the example.
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

import { programVersion } from "./program_version.mjs";

const root = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
const { name, ...others } = JSON.parse(readFileSync(path.join(root, "element/package.json"), "utf8"));
writeFileSync(path.join(root, "element/dist/package.json"), `${JSON.stringify({ name, version: programVersion(), ...others }, null, 2)}\n`);
copyFileSync(path.join(root, "../LICENSE"), path.join(root, "element/dist/LICENSE"));
copyFileSync(path.join(root, "element/example.html"), path.join(root, "element/dist/example.html"));
