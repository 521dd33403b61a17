// The page's root: the water, or a pad for phones. What only one of them needs is loaded by that one.
import "./style.css";
import { isEmbeddedAddress, isPadAddress } from "./app/address";
import { showPoster } from "./app/poster";
import { translation } from "./net/translation";
import { languageNow } from "./ui/language";

if (isEmbeddedAddress(location)) {
  document.body.classList.add("embedded");
  const panel = new URLSearchParams(location.search).get("panel");
  if (panel === "tools" || panel === "all") document.body.dataset["panel"] = panel;
}
const language = (document.documentElement.lang = languageNow());
// Before any module that reads the tables of texts.
const inLanguage = language === "de" ? import("./ui/texts_de").then(({ kGermanTranslation }) => Object.assign(translation, kGermanTranslation)) : Promise.resolve();
if (isPadAddress(location) && !isEmbeddedAddress(location)) {
  document.body.replaceChildren();
  void inLanguage.then(() => import("./pad/pad_page")).then(({ openPad }) => openPad());
} else {
  void showPoster();
  void inLanguage.then(() => import("./app/water_page")).then(({ openWaterPage }) => openWaterPage());
}
