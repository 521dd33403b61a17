// Small helpers for the page's elements.
import { fixed } from "./numbers";

/** Returns the element with this id; a missing one is a bug of the page. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) throw new Error(`index.html has no element "${id}"`);
  return element as T;
}

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  children: (Node | string)[] = [],
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** Writes the text only if it changed, so that frequent updates cause no layout work. */
export function setText(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** True for elements that use keys themselves: sliders, lists, text fields. */
export function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && (target.matches("input, select, textarea") || target.isContentEditable);
}

/** Formats a value with as many decimals as the step has, at most four. */
export function formatBy(step: number, value: number): string {
  const decimals = Math.min(Math.max(Math.ceil(-Math.log10(step) - 1e-9), 0), 4);
  return fixed(value, decimals);
}

const kSvg = "http://www.w3.org/2000/svg";

/** Makes an icon of one stroke, in a square of 24. */
export function makeIcon(stroke: string): SVGSVGElement {
  const icon = document.createElementNS(kSvg, "svg");
  const path = document.createElementNS(kSvg, "path");
  icon.setAttribute("viewBox", "0 0 24 24");
  icon.setAttribute("aria-hidden", "true");
  path.setAttribute("d", stroke);
  icon.append(path);
  return icon;
}
