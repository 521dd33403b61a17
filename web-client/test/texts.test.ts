// The tables of texts: complete in both languages, and the only place in the sources with texts for people.
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import ts from "typescript";
import { describe, expect, it, vi } from "vitest";

import { kNetTexts } from "../src/net/net_texts";
import { kClassTexts } from "../src/ui/class_texts";
import { kFrontTexts } from "../src/ui/front_texts";
import { kGaugeTexts } from "../src/ui/gauge_texts";
import { kKeysTexts } from "../src/ui/keys_texts";
import { kKioskTexts } from "../src/ui/kiosk_texts";
import { addressIn, languageOf, unknownLanguage } from "../src/ui/language";
import { kPadTexts } from "../src/ui/pad_texts";
import { kShareTexts } from "../src/ui/share_texts";
import { kTexts } from "../src/ui/texts";
import { kGermanTranslation } from "../src/ui/texts_de";

const kRoot = join(import.meta.dirname, "..");
/** Folders whose literals are looked through; what people see is made there. What `embed` says is for the program of the page around. */
const kFolders = ["app", "class", "front", "gauges", "kiosk", "net", "pad", "ui"];
const isTable = (file: string): boolean => /^(ui|net)\/(\w+_)?texts(_de)?\.ts$/.test(file) && !/(game|fidelity)_texts/.test(file);

/** A text for people: two words, or one with a capital and then a small letter. */
const isText = (literal: string): boolean => /\p{L}{2,}[,.:;]? \p{L}/u.test(literal) || /^[^\p{L}]*\p{Lu}\p{Ll}+[^\p{L}]*$/u.test(literal);

/** Calls whose arguments are for the program, its log, or are thrown at its programmer. */
const kCalls = /^(querySelector(All)?|matches|closest|matchMedia|getContext|addEventListener|dispatchEvent|playEffect|fetch|test|exec|match|replace(All)?|split|startsWith|setProperty|setAttribute|defineProperty|get|has|Event|RegExp)$/;
/** Properties that name no text: CSS classes, fonts, what a canvas draws with. */
const kProperties = /^(class|d|viewBox|role|transform|font|textAlign|headers|Authorization|Content-Type|standing)$/;
/** Literals that are no texts for people in a language of theirs, and why. */
const kExceptions: Record<string, string> = {
  "… – Spindrift": "the program's name",
  "button, input, select, summary, a[href]": "a selector",
  Enter: "a key's code", Space: "a key's code",
  "700 12px system-ui, sans-serif": "a font", "600 12px system-ui, sans-serif": "a font",
  "… ms": "a unit",
  "spindrift: kiosk: …; the page is not loaded again before the server answers": "in the console",
  "spindrift: kiosk: …; the page loads again (reload … in a row)": "in the console",
  "spindrift: the picture of … is drawn without land: …": "in the console",
  "no picture for … s": "in the console", "no connection for … s": "in the console",
  Spindrift: "the program's name",
  "velocity x [m/s]": "in a table that programs read", "velocity z [m/s]": "in a table that programs read",
  "kiosk=… in the address: expected seconds from … to …; … are used": "for who sets the kiosk up, as other parameters of the address",
  "12px system-ui, sans-serif": "a font",
  "read back": "a stage of drawing, in the console",
  "the middle": "the value of a choice",
  'index.html has no element "…"': "a bug of the page",
  '<script type="module" src="…"></script>\n<spindrift-water …></spindrift-water>\n': "code to copy",
};

/** Name of the function that gets this literal, directly or in an object or array; empty if none does. */
function callOf(node: ts.Node): string {
  for (let at: ts.Node = node; at.parent; at = at.parent)
    if ((ts.isCallExpression(at.parent) || ts.isNewExpression(at.parent)) && at.parent.arguments?.includes(at as ts.Expression)) {
      const callee = at.parent.expression;
      return ts.isPropertyAccessExpression(callee) ? callee.name.text : callee.getText();
    } else if (ts.isFunctionLike(at.parent)) return "";
  return "";
}

/** A literal whose text people see, whatever it looks like: a child in make(), the text in setText(), or a property that is shown. */
function isShown(node: ts.Node): boolean {
  const { parent } = node;
  if (ts.isPropertyAssignment(parent) && parent.initializer === node) return /^"?(label|title|help|aria-label|placeholder|alt)"?$/.test(parent.name.getText());
  const holder = ts.isArrayLiteralExpression(parent) ? parent : node;
  return ts.isCallExpression(holder.parent) && ((holder !== node && holder.parent.expression.getText() === "make") || (holder.parent.expression.getText() === "setText" && holder.parent.arguments[1] === node));
}

/** Literals of a source that look like texts for people. */
function textsIn(name: string, source: string): { text: string; place: string }[] {
  const file = ts.createSourceFile(name, source, ts.ScriptTarget.Latest, true);
  const found: { text: string; place: string }[] = [];
  const look = (node: ts.Node): void => {
    if (ts.isImportDeclaration(node) || ts.isExportDeclaration(node) || ts.isTypeNode(node)) return;
    const text = ts.isStringLiteralLike(node) ? node.text : ts.isTemplateExpression(node) ? [node.head.text, ...node.templateSpans.map(({ literal }) => literal.text)].join("…") : undefined;
    if (text !== undefined && (isText(text) || (isShown(node) && /\p{L}{2}/u.test(text)))) {
      const { parent } = node;
      const property = ts.isPropertyAssignment(parent) && parent.initializer === node ? parent.name.getText().replace(/"/g, "") : ts.isBinaryExpression(parent) && ts.isPropertyAccessExpression(parent.left) ? parent.left.name.text : "";
      const isKey = ts.isPropertyAssignment(parent) && parent.name === node;
      if (!isKey && !kProperties.test(property) && !kCalls.test(callOf(node))) found.push({ text, place: `${name}:${file.getLineAndCharacterOfPosition(node.getStart()).line + 1}` });
    }
    ts.forEachChild(node, look);
  };
  look(file);
  return found;
}

/** All texts of a table by their keys; of functions their source. */
function entries(table: object, prefix = ""): Map<string, string> {
  return new Map(Object.entries(table).flatMap(([key, value]: [string, unknown]): [string, string][] =>
    typeof value === "object" && value !== null ? [...entries(value, `${prefix}${key}.`)] : [[prefix + key, String(value)]]));
}

/** The English tables by their names in a translation, with the names by which the sources read them. */
const kTables = {
  page: ["kTexts", kTexts], net: ["kNetTexts", kNetTexts], gauge: ["kGaugeTexts", kGaugeTexts], front: ["kFrontTexts", kFrontTexts], kiosk: ["kKioskTexts", kKioskTexts],
  class: ["kClassTexts", kClassTexts], pad: ["kPadTexts", kPadTexts], share: ["kShareTexts", kShareTexts], keys: ["kKeysTexts", kKeysTexts],
} as const satisfies Record<Exclude<keyof typeof kGermanTranslation, "locale">, readonly [string, object]>;

/** Keys whose texts are the same in both languages. */
const kSame = [
  "page.languages.en", "page.languages.de", "page.failed", "page.detail.label", "page.page.detail", "page.kinds.ball", "page.commands.parameter", "page.commands.team", "page.token.label",
  "page.tools.finger.label", "page.lessonTools.finger", "page.qualities.minimal", "page.page.pause", "page.commands.pause", "page.levelLimits.none", "page.levelLimits.choice",
  "page.looks.natural.title", "page.looks.thesis.title", "page.vibration.label", "share.link", "share.notes.room", "class.teams", "pad.nameAnimals.0", "gauge.csv", "gauge.picture", "front.refusedRoom",
];

describe("the tables", () => {
  const { page: kGerman } = kGermanTranslation as { page: typeof kTexts };
  const tables = Object.entries(kTables).map(([name, [, english]]) => [name, english, kGermanTranslation[name as keyof typeof kTables]!] as const);

  it("have the same keys, and functions for the same keys", () => {
    for (const [, english, german] of tables) {
      const without = (table: object): string[] => [...entries({ ...table, scenes: {} }).keys()].filter((key) => !key.startsWith("scenes.")).sort();
      expect(without(german)).toEqual(without(english));
    }
  });

  it("have no empty texts but those that are empty in both", () => {
    for (const [, english, german] of tables) {
      const before = entries(english);
      expect([...entries(german)].filter(([key, text]) => text === "" && before.get(key) !== "")).toEqual([]);
    }
  });

  it("differ, except for words that both languages have", () => {
    const same = tables.flatMap(([name, english, german]) => {
      const before = entries(english);
      return [...entries(german)].filter(([key, text]) => before.get(key) === text && !/^rows\.\d+\.0$/.test(key)).map(([key]) => `${name}.${key}`);
    });
    expect(same.sort()).toEqual([...kSame].sort());
  });

  it("have no text that nothing uses", () => {
    const sourcesOf = (folder: string): string => readdirSync(join(kRoot, folder), { recursive: true, encoding: "utf8" }).filter((file) => file.endsWith(".ts") && !isTable(file)).map((file) => readFileSync(join(kRoot, folder, file), "utf8")).join("\n");
    // The client reads the same table of the connection under its own name.
    const sources = sourcesOf("src") + sourcesOf("client").replaceAll("kSessionTexts", "kNetTexts");
    for (const [name, table] of Object.values(kTables)) {
      // Those of quantities and switches are read by a variable's value.
      const isRead = (key: string): boolean => new RegExp(`\\b${name}\\.${key}\\b`).test(sources) || /^(on|off|ordinal|elevation|velocityX|velocityZ)$/.test(key);
      expect(Object.keys(table).filter((key) => !isRead(key))).toEqual([]);
    }
  });

  it("name every shipped scene in German, and no other", () => {
    const shipped = readdirSync(join(kRoot, "..", "server", "scenes")).filter((file) => file.endsWith(".textproto")).map((file) => file.replace(".textproto", ""));
    expect(Object.keys(kGerman.scenes).sort()).toEqual(shipped.sort());
  });

  it("fit names into the pad's field", () => {
    for (const { nameKinds, nameAnimals } of [kPadTexts, kGermanTranslation.pad as typeof kPadTexts]) {
      const longest = (names: readonly string[]): number => Math.max(...names.map((name) => name.length));
      expect(longest(nameKinds) + 1 + longest(nameAnimals)).toBeLessThanOrEqual(24);
    }
  });

  it("are read in German where that was loaded before, with German numbers", async () => {
    vi.resetModules();
    const { kGermanTranslation } = await import("../src/ui/texts_de");
    Object.assign((await import("../src/net/translation")).translation, kGermanTranslation);
    const [{ kTexts: page }, { kNetTexts: net }, numbers] = [await import("../src/ui/texts"), await import("../src/net/net_texts"), await import("../src/ui/numbers")];
    expect([page.page.splash, net.restarts, page.speedBy("Ada", 0.5)]).toEqual(["Platscher", "der Server startet neu", "Ada hat die Geschwindigkeit auf 0,5 × gestellt."]);
    expect([numbers.fixed(1234.5, 2), numbers.plain(0.25), numbers.grouped(12345)]).toEqual(["1234,50", "0,25", "12.345"]);
    vi.resetModules();
    const english = await import("../src/ui/numbers");
    expect([english.fixed(1234.5, 2), english.plain(0.25), english.grouped(12345)]).toEqual(["1234.50", "0.25", "12,345"]);
  });
});

describe("texts for people", () => {
  const files = kFolders.flatMap((folder) => readdirSync(join(kRoot, "src", folder)).filter((file) => file.endsWith(".ts")).map((file) => `${folder}/${file}`)).filter((file) => !isTable(file));
  const found = files.flatMap((file) => textsIn(file, readFileSync(join(kRoot, "src", file), "utf8")));

  it("are found by the search, and nothing else is", () => {
    const places = (source: string): string[] => textsIn("a.ts", source).map(({ text }) => text);
    expect(places('make("p", { title: "Drag it" }, ["Splash", `${a} more of it`]);')).toEqual(["Drag it", "Splash", "… more of it"]);
    expect(places('make("p", { title: "drag" }, ["splash"]); setText(a, "wave"); setText(b, ""); row({ label: "boat", name: "boat" });')).toEqual(["drag", "splash", "wave", "boat"]);
    expect(places('import a from "./Some file"; make("p", { class: "select row", id: "my-boat" }); x.querySelector("a b c"); send(y, "Ball game");')).toEqual(["Ball game"]);
  });

  it("stand in the tables alone", () => {
    expect(found.filter(({ text }) => !(text in kExceptions))).toEqual([]);
  });

  it("have no exception that is not used", () => {
    expect(Object.keys(kExceptions).filter((text) => !found.some((each) => each.text === text))).toEqual([]);
  });

  it("are keys in index.html, and each key is one of the table", () => {
    const page = readFileSync(join(kRoot, "index.html"), "utf8").replace(/<head>[\s\S]*<\/head>/, "").replace(/<!--[\s\S]*?-->/g, "");
    expect(page.match(/\b(aria-label|title|alt|placeholder)="[^"]+"/g) ?? []).toEqual([]);
    const shown = [...page.matchAll(/>([^<]*)</g)].map(([, text]) => text!.trim()).filter((text) => /\p{L}/u.test(text));
    expect(shown).toEqual(["Spindrift", "Spindrift", "kB/s"]);
    const keys = [...page.matchAll(/\bdata-(?:text|label|tip)="([^"]*)"/g)].map(([, key]) => key!);
    expect(keys.filter((key) => !(key in kTexts.page))).toEqual([]);
    expect(Object.keys(kTexts.page).filter((key) => !keys.includes(key))).toEqual([]);
  });
});

describe("the page's language", () => {
  it("is that of the address, then the chosen one, then the browser's first that the page has", () => {
    expect(languageOf("?lang=de", "en", ["en-GB"])).toBe("de");
    expect(languageOf("", "de", ["en-GB"])).toBe("de");
    expect(languageOf("", undefined, ["fr", "de-AT", "en"])).toBe("de");
    expect(languageOf("", undefined, ["fr"])).toBe("en");
    expect(languageOf("", undefined, [])).toBe("en");
  });

  it("is the browser's if the address names another, which is told", () => {
    expect(languageOf("?lang=xx", undefined, ["de"])).toBe("de");
    expect(unknownLanguage("?lang=xx")).toBe("xx");
    expect(unknownLanguage("?lang=")).toBe("");
    expect([unknownLanguage(""), unknownLanguage("?lang=de")]).toEqual([undefined, undefined]);
    expect(kTexts.unknownLanguage("xx", "en, de")).toContain("lang=xx");
  });

  it("is changed in the address only if it stands there", () => {
    expect(addressIn("de", "http://h/?room=a")).toBe("http://h/?room=a");
    expect(addressIn("de", "http://h/?lang=en&room=a")).toBe("http://h/?lang=de&room=a");
  });
});
