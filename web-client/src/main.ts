// The page's root: the water, or a pad for phones. What only one of them needs is loaded by that one.
import "./style.css";
import { isEmbeddedAddress, isPadAddress } from "./app/address";
import { showPoster } from "./app/poster";

if (isEmbeddedAddress(location)) {
  document.body.classList.add("embedded");
  const panel = new URLSearchParams(location.search).get("panel");
  if (panel === "tools" || panel === "all") document.body.dataset["panel"] = panel;
}
if (isPadAddress(location) && !isEmbeddedAddress(location)) {
  document.body.replaceChildren();
  void import("./pad/pad_page").then(({ openPad }) => openPad());
} else {
  void showPoster();
  void import("./app/water_page").then(({ openWaterPage }) => openWaterPage());
}
