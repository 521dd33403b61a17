// The structure of client/ and src/: no include cycle, no folder that imports one above it, no export that only tests use.
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import ts from "typescript";
import { describe, expect, it } from "vitest";

const kRoot = join(import.meta.dirname, "..");
/** Folders from the lowest to the highest; each may import from itself and from those before it. Those of the package first. */
const kFolders = [
  "client/gen", "client/codec", "client/session", "client/rest", "client/water", "client", "client/mcp",
  "net",
  "scene/maths", "scene/drawing", "scene/shaders", "scene/meshes", "scene/frames", "scene/light", "scene/landscape", "scene/camera", "scene/sea", "scene/boats", "scene/floaters", "scene/shore",
  "scene/shadows", "scene/solids", "scene/water", "scene/rain", "scene/whitewater", "scene/fluid", "scene/looks", "scene",
  "sound", "ui", "gauges", "class", "kiosk", "embed", "app", "pad", "front", ".",
];
/** Roots: nothing has to import them. */
const kRoots = ["main.ts", "net/worker.ts", "client/index.ts", "client/vite.config.ts", "client/mcp/main.ts"];

const sourcesIn = (folder: string): string[] => readdirSync(join(kRoot, folder), { recursive: true, encoding: "utf8" }).filter((file) => /^(?!dist\/).*(?<!\.d)\.ts$/.test(file));
const pathOf = (file: string): string => join(kRoot, file.startsWith("client/") ? "" : "src", file);
/** Those of src/ without it, those of the package with client/ before. */
const files = [...sourcesIn("src"), ...sourcesIn("client").map((file) => `client/${file}`)];
const texts = new Map(files.map((file) => [file, readFileSync(pathOf(file), "utf8")]));

/** Files that `file` imports, types included. */
function importsOf(file: string): string[] {
  return ts
    .preProcessFile(texts.get(file)!)
    .importedFiles.map(({ fileName }) => fileName)
    .filter((name) => name.startsWith("."))
    .map((name) => relative(kRoot, join(dirname(pathOf(file)), name)).replace(/^src\//, ""))
    .map((name) => (texts.has(`${name}.ts`) ? `${name}.ts` : name))
    .filter((name) => texts.has(name));
}

/** Returns a cycle in a graph as a list of nodes that begins and ends with the same one, or an empty list. */
function findCycle(edges: ReadonlyMap<string, readonly string[]>): string[] {
  const done = new Set<string>();
  const visit = (node: string, path: string[]): string[] => {
    const at = path.indexOf(node);
    if (at >= 0) return [...path.slice(at), node];
    if (done.has(node)) return [];
    for (const next of edges.get(node) ?? []) {
      const cycle = visit(next, [...path, node]);
      if (cycle.length > 0) return cycle;
    }
    done.add(node);
    return [];
  };
  for (const node of edges.keys()) {
    const cycle = visit(node, []);
    if (cycle.length > 0) return cycle;
  }
  return [];
}

function folderOf(file: string): string {
  return file.startsWith("client/gen/") ? "client/gen" : dirname(file);
}

describe("the search for a cycle", () => {
  it("finds one, also between types only, and nothing in a tree without circles", () => {
    const graph = (edges: Record<string, string[]>) => new Map(Object.entries(edges));
    expect(findCycle(graph({ a: ["b", "c"], b: ["c"], c: ["d"], d: ["b"] }))).toEqual(["b", "c", "d", "b"]);
    expect(findCycle(graph({ a: ["b", "c"], b: ["c"], c: [] }))).toEqual([]);
    expect(ts.preProcessFile('import type { A } from "./a";').importedFiles.map(({ fileName }) => fileName)).toEqual(["./a"]);
  });
});

describe("the imports", () => {
  const edges = new Map(files.map((file) => [file, importsOf(file)]));

  it("are found", () => {
    expect(edges.get("app/app.ts")).toContain("client/codec/greeting.ts");
    const unreached = files.filter((file) => !kRoots.includes(file) && ![...edges.values()].some((imported) => imported.includes(file)));
    expect(unreached).toEqual([]);
  });

  it("have no cycle", () => {
    expect(findCycle(edges)).toEqual([]);
  });

  it("go down from folder to folder only", () => {
    const upward = [...edges].flatMap(([file, imported]) =>
      imported.filter((other) => kFolders.indexOf(folderOf(other)) > kFolders.indexOf(folderOf(file))).map((other) => `${file} -> ${other}`),
    );
    expect(files.map(folderOf).filter((folder) => !kFolders.includes(folder))).toEqual([]);
    expect(upward).toEqual([]);
  });
});

describe("the exports", () => {
  const own = files.filter((file) => !file.startsWith("client/gen/"));
  const tests = readdirSync(import.meta.dirname, "utf8").map((file) => readFileSync(join(import.meta.dirname, file), "utf8"));
  const countOf = (text: string, name: string): number => text.match(new RegExp(`\\b${name}\\b`, "g"))?.length ?? 0;
  const exportsOf = (kinds: string): [file: string, name: string][] =>
    own
      .filter((file) => !kRoots.includes(file))
      .flatMap((file) => [...texts.get(file)!.matchAll(new RegExp(`^export (?:${kinds}) (\\w+)`, "gm"))].map((match): [string, string] => [file, match[1]!]));

  it("all have a use in the sources, not only in tests", () => {
    const unused = exportsOf("class|const|function|interface|type").filter(
      ([file, name]) => !own.some((other) => countOf(texts.get(other)!, name) > (other === file ? 1 : 0)),
    );
    expect(unused).toEqual([]);
  });

  it("all have a user in another file, if they are values", () => {
    const inner = exportsOf("class|const|function").filter(
      ([file, name]) => !own.some((other) => other !== file && countOf(texts.get(other)!, name) > 0) && !tests.some((text) => countOf(text, name) > 0),
    );
    expect(inner).toEqual([]);
  });
});

describe("the files", () => {
  it("have at most 400 lines", () => {
    const long = files.filter((file) => !file.startsWith("client/gen/") && texts.get(file)!.split("\n").length > 401);
    expect(long).toEqual([]);
  });
});
