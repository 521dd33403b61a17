// The page's language: of the address, of an earlier choice by hand, or of the browser.
import { keepChoice, keptChoice } from "./kept";

export const kLanguages = ["en", "de"] as const;
export type Language = (typeof kLanguages)[number];

const kKey = "language";
const isKnown = (name: string | undefined): name is Language => kLanguages.some((language) => language === name);

/** Returns `?lang=` of the address if the page has that language, otherwise what was chosen by hand, otherwise the first of the browser's
 *  languages that the page has, otherwise English. */
export function languageOf(search: string, kept: string | undefined, browsers: readonly string[]): Language {
  const primary = browsers.map((tag) => tag.toLowerCase().split("-")[0]);
  return [new URLSearchParams(search).get("lang") ?? undefined, kept, ...primary].find(isKnown) ?? "en";
}

/** Returns what `?lang=` asks for in vain; undefined if it is left out, or names a language of the page. */
export function unknownLanguage(search: string): string | undefined {
  const wanted = new URLSearchParams(search).get("lang") ?? undefined;
  return isKnown(wanted) ? undefined : wanted;
}

/** Returns the language of this page at this address. */
export function languageNow(): Language {
  return languageOf(location.search, keptChoice(kKey), navigator.languages);
}

/** Keeps a choice by hand for later visits, and returns the page's address in that language. */
export function addressIn(language: Language, page: string): string {
  keepChoice(kKey, language);
  const url = new URL(page);
  if (url.searchParams.has("lang")) url.searchParams.set("lang", language);
  return url.href;
}
