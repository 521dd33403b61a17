// `./dev gallery` calls this; see docs/contributing.md. Pictures go to build/gallery.
import { existsSync, readFileSync } from "node:fs";
import { parseArgs } from "node:util";

import { launch } from "../chromium.mjs";
import { shootClass } from "./class.mjs";
import { described } from "./compare.mjs";
import { shootAnimation, shootTour } from "./films.mjs";
import { check, keptPath, kMade, differencePath, madePath, makePictures, write } from "./pictures.mjs";
import { shootReadme } from "./readme.mjs";
import { writeSheet } from "./sheet.mjs";
import { lightsOf, shippedScenes } from "./shots.mjs";

const kUsage = "usage: main.mjs [pictures|readme|class|animation|tour|all] [--scenes A,B] [--lights NOON,DUSK] [--qualities low,high] [--update]";

function readOptions() {
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: { scenes: { type: "string" }, lights: { type: "string" }, qualities: { type: "string" }, update: { type: "boolean", default: false } },
  });
  const list = (text) => text?.split(",").map((each) => each.trim());
  const [part = "pictures", ...rest] = positionals;
  const qualities = list(values.qualities) ?? ["low", "high"];
  const scenes = list(values.scenes) ?? shippedScenes();
  if (rest.length > 0 || !["pictures", "readme", "class", "animation", "tour", "all"].includes(part)) throw new Error(kUsage);
  for (const quality of qualities) if (!["low", "high"].includes(quality)) throw new Error(`there is no quality "${quality}": low, high`);
  for (const scene of scenes) if (!shippedScenes().includes(scene)) throw new Error(`there is no scene "${scene}": ${shippedScenes().join(", ")}`);
  return { part, scenes, lights: list(values.lights), qualities, isUpdate: values.update };
}

/** Returns the number of pictures that differ from the kept ones, or have none. */
async function shootPictures(context, { scenes, lights, qualities, isUpdate }) {
  const scratch = await context.newPage();
  const counts = { made: 0, failed: 0, updated: 0 };
  for (const quality of qualities)
    for (const scene of scenes)
      for await (const { name, file } of makePictures(context, { scene, quality, lights: lights ?? lightsOf(scene) })) {
        ++counts.made;
        const difference = await check(scratch, name, file);
        console.log(`${name}: ${difference ? described(difference) : "none is kept"}`);
        if (isUpdate) {
          if (existsSync(keptPath(name)) && readFileSync(keptPath(name)).equals(file)) continue;
          write(keptPath(name), file);
          ++counts.updated;
        } else if (!difference?.isLike) {
          ++counts.failed;
          console.log(`  differs: ${madePath(name)}\n  kept:    ${keptPath(name)}\n  places:  ${difference ? differencePath(name) : "-"}`);
        }
      }
  await scratch.close();
  console.log(`${counts.made} pictures in ${kMade}${isUpdate ? `, ${counts.updated} kept anew` : `, ${counts.failed} differ`}`);
  return counts.failed;
}

let options;
try {
  options = readOptions();
} catch (error) {
  console.error(error.message);
  process.exit(2);
}
const browser = await launch();
try {
  const context = await browser.newContext();
  const does = (part) => options.part === part || options.part === "all";
  if (does("pictures")) {
    if ((await shootPictures(context, options)) > 0) process.exitCode = 1;
    for (const path of await writeSheet(context)) console.log(path);
  }
  if (does("readme")) for await (const path of shootReadme(context)) console.log(path);
  if (does("class")) for await (const path of shootClass(context)) console.log(path);
  if (does("animation")) console.log(await shootAnimation(context, options.qualities));
  if (does("tour")) console.log(await shootTour(context, options.qualities));
} finally {
  await browser.close();
}
