// Measures what a browser loads before anything is opened, file by file, by the manifest of a production build: the page, its scripts with
// all that they import, styles, the worker with its WebAssembly, and one still. Run by itself, it prints a table for each kind of page.
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync } from "node:zlib";

import { build } from "vite";

const client_root = dirname(dirname(fileURLToPath(import.meta.url)));
/** What index.html's script opens. */
const kPages = { water: "src/app/water_page.ts", front: "src/front/front_page.ts", pad: "src/pad/pad_page.ts" };
/** What a page in German loads besides. */
const kGerman = "src/ui/texts_de.ts";

/** Builds the page in memory. Returns for each page of `kPages` its files in English and the German texts:
 *  `[{ file, content, plain, brotli }]`, the last two in bytes. */
export async function measureFirstLoad() {
  const { output } = await build({ root: client_root, logLevel: "warn", build: { write: false, manifest: true } });
  const sources = new Map(output.map((each) => [each.fileName, Buffer.from(each.type === "chunk" ? each.code : each.source)]));
  const manifest = JSON.parse(String(sources.get(".vite/manifest.json")));
  const sizes = new Map();
  const sizeOf = (file) => {
    if (!sources.has(file)) throw new Error(`the build has no file ${file}`);
    const content = sources.get(file);
    if (!sizes.has(file)) sizes.set(file, { file, content, plain: content.length, brotli: file.endsWith(".webp") ? content.length : brotliCompressSync(content).length });
    return sizes.get(file);
  };
  const filesOf = (entry, found = new Set()) => {
    const chunk = manifest[entry];
    if (!chunk) throw new Error(`the build has no ${entry}`);
    if (found.has(chunk.file)) return found;
    for (const file of [chunk.file, ...(chunk.css ?? []), ...(chunk.assets ?? [])]) found.add(file);
    for (const each of chunk.imports ?? []) filesOf(each, found);
    return found;
  };
  return Object.fromEntries(
    Object.entries(kPages).map(([page, entry]) => {
      const files = ["index.html", ...filesOf(entry, filesOf("index.html"))].map(sizeOf);
      const [largestStill, ...otherStills] = files.filter(({ file }) => file.endsWith(".webp")).sort((a, b) => b.plain - a.plain);
      // Only the water has a still.
      const unused = page === "water" && largestStill ? otherStills : [largestStill, ...otherStills];
      return [page, { english: files.filter((each) => !unused.includes(each)).sort((a, b) => b.plain - a.plain), german: [...filesOf(kGerman)].map(sizeOf).filter((each) => !files.includes(each)) }];
    }),
  );
}

export function sumOf(files) {
  return { plain: files.reduce((sum, { plain }) => sum + plain, 0), brotli: files.reduce((sum, { brotli }) => sum + brotli, 0) };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const line = (name, { plain, brotli }) => console.log(`${String(plain).padStart(9)} ${String(brotli).padStart(8)}  ${name}`);
  for (const [page, { english, german }] of Object.entries(await measureFirstLoad())) {
    console.log(`${page}: bytes plain and by brotli`);
    for (const each of english) line(each.file, each);
    line("all", sumOf(english));
    line("all, in German", sumOf([...english, ...german]));
  }
}
