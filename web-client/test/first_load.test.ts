// What a browser loads before anything is opened, by a production build: `node scripts/first_load.mjs` prints it file by file.
import { beforeAll, describe, expect, it } from "vitest";

import { measureFirstLoad, sumOf } from "../scripts/first_load.mjs";
import { kClassTexts } from "../src/ui/class_texts";
import { kFrontTexts } from "../src/ui/front_texts";
import { kGaugeTexts } from "../src/ui/gauge_texts";
import { kKeysTexts } from "../src/ui/keys_texts";
import { kKioskTexts } from "../src/ui/kiosk_texts";
import { kPadTexts } from "../src/ui/pad_texts";
import { kShareTexts } from "../src/ui/share_texts";
import { kTexts } from "../src/ui/texts";

const kMostBytes = { plain: 1_200_000, brotli: 450_000 };

describe("the first load", () => {
  let pages: Awaited<ReturnType<typeof measureFirstLoad>>;
  beforeAll(async () => {
    pages = await measureFirstLoad();
  }, 120_000);
  const withoutHash = (file: string): string => file.replace(/-[\w-]{8}\./, ".");

  it("is at most 1.2 MB, compressed 450 kB, in German too", () => {
    for (const [page, { english, german }] of Object.entries(pages)) {
      const sums = sumOf([...english, ...german]);
      for (const coding of ["plain", "brotli"] as const) expect(sums[coding], `bytes of the ${page} page, ${coding}`).toBeLessThanOrEqual(kMostBytes[coding]);
    }
  });

  it("has the page, its scripts and styles, the worker and one still", () => {
    for (const [page, { english }] of Object.entries(pages)) {
      const names = english.map(({ file }) => withoutHash(file));
      expect(names).toEqual(expect.arrayContaining(["index.html", "assets/index.js", "assets/index.css", `assets/${page}_page.js`, "assets/worker.js"]));
      expect(names.filter((name) => name.endsWith(".webp"))).toHaveLength(page === "water" ? 1 : 0);
    }
  });

  it("has no German texts in an English page, and none of what is opened later", () => {
    for (const { english, german } of Object.values(pages)) {
      expect(english.map(({ file }) => withoutHash(file))).not.toContain("assets/texts_de.js");
      expect(german.map(({ file }) => withoutHash(file))).toEqual(["assets/texts_de.js"]);
    }
    const loaded = pages["water"]!.english.map(({ content }) => String(content)).join("\n");
    expect(loaded).toContain(kTexts.noEffects);
    for (const text of [kClassTexts.endGame, kFrontTexts.lead, kGaugeTexts.pauseHelp, kKeysTexts.rows[0]![1], kKioskTexts.invite, kPadTexts.mayWatch, kShareTexts.notes.copy]) expect(loaded).not.toContain(text);
  });
});
