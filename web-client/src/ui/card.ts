// A card over the page, which takes the keyboard while it is open: a modal dialog.
import { make } from "./dom";

/** Escape, a press beside the card, and the button close it. It is in the document from now on, closed. */
export function makeCard(name: string, title: string, children: (Node | string)[], closeButton: HTMLButtonElement): HTMLDialogElement {
  const dialog = make("dialog", { class: name, "data-testid": name, "aria-label": title }, children);
  closeButton.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", ({ target }) => target === dialog && dialog.close());
  // The page's own keys choose tools. A card that is closed keeps the focus until the next frame.
  dialog.addEventListener("keydown", (event) => dialog.open && event.stopPropagation());
  document.body.append(dialog);
  return dialog;
}
