// A message over the whole page, for errors that stop the picture.
import { byId, setText } from "./dom";

/** An empty text hides the notice. */
export function showNotice(text: string): void {
  setText(byId("notice-text"), text);
  byId("notice").hidden = text === "";
}
