// The page's root: the water of a room, the front page with all rooms, or a pad for phones. What only one of them needs is loaded by that one.
import "./style.css";
import { isEmbeddedAddress, isPadAddress, takeLinkToken } from "./app/address";
import { showPoster } from "./app/poster";
import { leadsToFront } from "./front/entrance";
import { IdentityStore, sessionStorageIfAny } from "./net/identity_store";
import { requestRooms } from "../client/rest/rooms";
import { roomOf } from "./net/room_address";
import { prepareWorker, socketUrl } from "./net/water_client";
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
  void openRoomOrFront();
}

async function openRoomOrFront(): Promise<void> {
  await inLanguage;
  const load = () => import("./app/water_page");
  // Most rooms that are named exist: their page is loaded meanwhile.
  const water = roomOf(location.search) ? load() : undefined;
  const url = socketUrl(location.href);
  // Only looked at: the page that is opened takes it out of the address.
  const token = takeLinkToken(location, { replaceState: () => {} }) ?? new IdentityStore(sessionStorageIfAny(), url).token;
  if (await leadsToFront(location.search, url, token, { requestRooms, fetch: (address, init) => fetch(address, init) })) {
    const { openFront } = await import("./front/front_page");
    return openFront();
  }
  void showPoster();
  prepareWorker();
  const { openWaterPage } = await (water ?? load());
  openWaterPage();
}
