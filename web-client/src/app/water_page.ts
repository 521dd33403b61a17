// The page that shows the water of a room, with its controls; with `?class` for a projector in front of a class, with `?kiosk` as an exhibit.
import { makeRenderer } from "../scene/drawing/renderer";
import { byId } from "../ui/dom";
import { fillPage } from "../ui/fill_page";
import { addLanguageRow } from "../ui/language_row";
import { showNotice } from "../ui/notice";
import { isEmbeddedAddress, isKioskAddress, isProjectorAddress } from "./address";
import { App } from "./app";
import { keepChangesInAddress } from "./changed_values";
import { connectInput } from "./input";
import { addShareButton } from "./share";
import { abandonWorker } from "../net/water_client";
import { wantsSteppedPictures } from "./stepped_pictures";
import { showPanels } from "./poster";
import { openWaterSpeaker } from "./water_speaker";
import { installTestHooks } from "./test_hooks";
import { kTexts } from "../ui/texts";

export function openWaterPage(): void {
  fillPage(document);
  const made = makeRenderer(byId<HTMLCanvasElement>("view"));
  const isKiosk = isKioskAddress(location) && !isEmbeddedAddress(location);
  const openKiosk = (app?: App): void => void (isKiosk && import("./kiosk_page").then((page) => page.openKiosk(app)));
  if (!made?.isSoftwareRenderer) showPanels();
  if (!made) {
    abandonWorker();
    openKiosk();
    showNotice(kTexts.noWebGl);
    return;
  }
  const app = new App(made);
  connectInput(app);
  if (isEmbeddedAddress(location)) void import("./embedded_page").then(({ openEmbeddedPage }) => openEmbeddedPage(app));
  else if (isProjectorAddress(location)) void import("./projector").then(({ openProjector }) => openProjector(app));
  if (isKiosk) openKiosk(app);
  else addVisitorControls(app);
  openWaterSpeaker(app);
  const isStepped = wantsSteppedPictures(location.search);
  installTestHooks(app, isStepped);
  app.start(!isStepped);
  // A link with a token was opened in this tab; without it the browser would load nothing.
  window.addEventListener("hashchange", () => location.reload());
}

/** What leads to other addresses, or sets something for others. */
function addVisitorControls(app: App): void {
  addShareButton(app);
  keepChangesInAddress(app);
  openOperatorPanel(app);
  addLanguageRow(() => app.address, (text) => app.warn(text));
}

/** Adds the operator's controls of a lesson when the server says that this visitor is one. */
function openOperatorPanel(app: App): void {
  let isAsked = false;
  app.lessons.watch(() => {
    if (isAsked || app.role !== "operator") return;
    isAsked = true;
    void import("../class/operator_panel").then(({ OperatorPanel }) => {
      byId("room-box").after(new OperatorPanel(app.lessons, () => app.entered, app.commands.send).element);
    });
  });
}
