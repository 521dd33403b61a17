// The page's root: the water, or a pad for phones. What only one of them needs is loaded by that one.
import "./style.css";
import { isPadAddress } from "./app/address";
import { showPoster } from "./app/poster";

if (isPadAddress(location)) {
  document.body.replaceChildren();
  void import("./pad/pad_page").then(({ openPad }) => openPad());
} else {
  void showPoster();
  void import("./app/water_page").then(({ openWaterPage }) => openWaterPage());
}
