// The texts of index.html, which has keys instead: data-text for what an element says, data-label for its name, data-tip for its tooltip.
import { kTexts } from "./texts";

/** Attribute of index.html → what gets the text of its key. */
const kFilled = {
  "data-text": (element: Element, text: string) => (element.textContent = text),
  "data-label": (element: Element, text: string) => element.setAttribute("aria-label", text),
  "data-tip": (element: Element, text: string) => element.setAttribute("title", text),
};

export function fillPage(root: Document): void {
  for (const [attribute, fill] of Object.entries(kFilled))
    for (const element of root.querySelectorAll(`[${attribute}]`)) fill(element, kTexts.page[element.getAttribute(attribute) as keyof typeof kTexts.page]);
  root.body.classList.remove("unfilled");
}
