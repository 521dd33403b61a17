// The shader files as text: what a browser would report only when it draws.
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it } from "vitest";

const kFolder = join(import.meta.dirname, "..", "src", "scene", "shaders");
const names = readdirSync(kFolder).filter((name) => !name.endsWith(".ts"));
const texts = new Map(names.map((name) => [name, readFileSync(join(kFolder, name), "utf8")]));
const table = readFileSync(join(kFolder, "materials.ts"), "utf8");

describe("the shader files", () => {
  it("include only files that exist and that the table of includes holds", () => {
    for (const [name, text] of texts)
      for (const [, included] of text.matchAll(/#include <(\w+)>/g)) {
        expect(texts.has(`${included}.glsl`), `${name} includes <${included}>`).toBe(true);
        expect(table, `materials.ts has no <${included}>`).toMatch(new RegExp(`import (\\w+) from "./${included}\\.glsl\\?raw";[^]*(\\b${included}: \\1|[{ ]\\1,)`));
      }
  });

  it("are all used", () => {
    for (const name of names) expect(table, `nothing uses ${name}`).toContain(`./${name}?raw`);
  });

  it("read only those varyings that the vertex shader of their program writes", () => {
    const fileOf = new Map([...table.matchAll(/import (\w+) from "\.\/([\w.]+)\?raw";/g)].map(([, variable, name]) => [variable!, name!]));
    const whole = (name: string): string => texts.get(name)!.replace(/#include <(\w+)>/g, (_, included: string) => whole(`${included}.glsl`));
    const programs = [...table.matchAll(/^ {2}(\w+): \[(\w+), (\w+)\],$/gm)];
    expect(programs.length).toBeGreaterThan(20);
    for (const [, program, vertex, fragment] of programs) {
      const written = new Set([...whole(fileOf.get(vertex!)!).matchAll(/^(?:flat )?out \w+ (\w+);/gm)].map(([, varying]) => varying));
      for (const [, varying] of whole(fileOf.get(fragment!)!).matchAll(/^(?:flat )?in \w+ (\w+);/gm)) expect(written, `${program}: nothing writes ${varying}`).toContain(varying);
    }
  });
});
