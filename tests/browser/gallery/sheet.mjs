// The contact sheet: a page with every picture made, and the same as one picture.
import { existsSync, readdirSync, writeFileSync } from "node:fs";
import { basename, dirname, join, relative } from "node:path";
import { pathToFileURL } from "node:url";

import { differencePath, keptPath, kMade } from "./pictures.mjs";
import { sceneOf } from "./shots.mjs";

const kColumnsCount = 5;
const kColumnPx = 404;
const kStyle = `body { margin: 8px; background: #16191c; color: #dde; font: 13px system-ui, sans-serif } h2 { font-size: 16px; margin: 12px 0 4px }
  main { display: grid; grid-template-columns: repeat(${kColumnsCount}, ${kColumnPx}px); gap: 6px } figure { margin: 0 } img { width: 100%; display: block }
  .differs { outline: 3px solid #e33 } a { color: inherit }`;

function figure(folder, name) {
  const link = (path) => relative(folder, path).replaceAll("\\", "/");
  const isDifferent = existsSync(differencePath(name));
  const more = isDifferent ? ` – <a href="${link(differencePath(name))}">difference</a>, <a href="${link(keptPath(name))}">kept</a>` : "";
  return `<figure${isDifferent ? ' class="differs"' : ""}><img src="pictures/${name}.webp" alt="${name}"><figcaption>${basename(name).replaceAll("_", " ")}${more}</figcaption></figure>`;
}

/** Writes index.html and contact_sheet.png beside the pictures. @returns {Promise<string[]>} their paths */
export async function writeSheet(context) {
  const folder = dirname(kMade);
  const parts = readdirSync(kMade).sort().reverse().map((quality) => {
    const names = readdirSync(join(kMade, quality)).filter((file) => file.endsWith(".webp")).map((file) => file.slice(0, -".webp".length)).sort();
    const rows = new Map();
    for (const name of names) rows.set(sceneOf(name), [...(rows.get(sceneOf(name)) ?? []), name]);
    const row = (scene) => `<main>${rows.get(scene).map((name) => figure(folder, `${quality}/${name}`)).join("\n")}</main>`;
    return `<h2>${quality} quality, ${names.length} pictures</h2>${[...rows.keys()].sort().map(row).join("\n")}`;
  });
  const html = join(folder, "index.html");
  writeFileSync(html, `<!doctype html><meta charset="utf-8"><title>Spindrift gallery</title><style>${kStyle}</style>${parts.join("")}`);
  const page = await context.newPage();
  await page.setViewportSize({ width: kColumnsCount * (kColumnPx + 6) + 10, height: 600 });
  await page.goto(pathToFileURL(html).href);
  const png = join(folder, "contact_sheet.png");
  await page.screenshot({ path: png, fullPage: true, timeout: 180_000 });
  await page.close();
  return [html, png];
}
