// The page's root.
import "./style.css";
import { App } from "./app/app";
import { connectInput } from "./app/input";
import { installTestHooks } from "./app/test_hooks";
import { wantsSteppedPictures } from "./app/stepped_pictures";
import { makeRenderer } from "./scene/drawing/renderer";
import { byId } from "./ui/dom";
import { showNotice } from "./ui/notice";

const made = makeRenderer(byId<HTMLCanvasElement>("view"));
if (made) {
  const app = new App(made);
  connectInput(app);
  const isStepped = wantsSteppedPictures(location.search);
  installTestHooks(app, isStepped);
  app.start(!isStepped);
  // A link with a token was opened in this tab; without it the browser would load nothing.
  window.addEventListener("hashchange", () => location.reload());
} else {
  showNotice(
    "This page needs WebGL 2 with floating-point targets, and this browser offers none. Turn on hardware acceleration, or try a current Firefox, Chrome, Edge or Safari.",
  );
}
