// The page's root: the water of a room, the front page with all rooms, or a pad for phones. What only one of them needs is loaded by that one.
import "./style.css";
import { isEmbeddedAddress, isKioskAddress, isPadAddress, isProjectorAddress, takeLinkToken } from "./app/address";
import { showPanels, showPoster } from "./app/poster";
import { leadsToFront } from "./front/entrance";
import { IdentityStore, sessionStorageIfAny } from "./net/identity_store";
import { requestRooms, type RoomSummary } from "../client/rest/rooms";
import { roomOf, wishOf } from "./net/room_address";
import { prepareConnection, prepareWorker, socketUrl } from "./net/water_client";
import { translation } from "./net/translation";
import { languageNow } from "./ui/language";

/** The room of an address that names none, as in the server. */
const kFirstRoom = "main";
/** The panels wait for the first picture at most so long. */
const kMostHiddenMs = 4000;

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
  showPanels();
  void inLanguage.then(() => import("./pad/pad_page")).then(({ openPad }) => openPad());
} else {
  void openRoomOrFront();
}

async function openRoomOrFront(): Promise<void> {
  await inLanguage;
  // Also where nothing comes.
  setTimeout(showPanels, kMostHiddenMs);
  // Most addresses lead to water, and whoever comes to the front page opens a room next.
  const water = import("./app/water_page");
  prepareWorker();
  const url = socketUrl(location.href);
  // Only looked at: the page that is opened takes it out of the address.
  const identity = new IdentityStore(sessionStorageIfAny(), url).peek(takeLinkToken(location, { replaceState: () => {} }));
  // None where the server may not tell who asks.
  const rooms = requestRooms(identity.token).catch((): RoomSummary[] => []);
  if (await leadsToFront(location.search, url, identity.token, { requestRooms: () => rooms, fetch: (address, init) => fetch(address, init) })) {
    const { openFront } = await import("./front/front_page");
    showPanels();
    return openFront();
  }
  const wish = wishOf(location.search);
  void rooms.then((all) => showPoster(all.find(({ name }) => name === (roomOf(location.search) || kFirstRoom))?.scene ?? wish?.scene));
  // The connection is there before the page is, which takes longer: frames, projectors and exhibits make their own.
  const isVisitor = ![isEmbeddedAddress, isProjectorAddress, isKioskAddress].some((isOne) => isOne(location));
  if (isVisitor) prepareConnection({ url, identity, wish });
  const { openWaterPage } = await water;
  openWaterPage();
}
