// Chooses the page's language by hand, and says when the address asks for one that the page does not have.
import { byId } from "./dom";
import { addressIn, kLanguages, unknownLanguage, type Language } from "./language";
import { SelectRow } from "./select_row";
import { kTexts } from "./texts";

/** `address` returns the page's address with all that was chosen up to now; the page is loaded again there. */
export function addLanguageRow(address: () => string, warn: (text: string) => void): void {
  const row = new SelectRow("language", kTexts.language, (value) => {
    const wanted = addressIn(value as Language, address());
    if (wanted === location.href) location.reload();
    else location.replace(wanted);
  });
  row.setChoices(kLanguages.map((language) => ({ value: language, label: kTexts.languages[language] })), document.documentElement.lang);
  byId("language-row").append(row.element);
  const unknown = unknownLanguage(location.search);
  if (unknown !== undefined) warn(kTexts.unknownLanguage(unknown, kLanguages.join(", ")));
}
