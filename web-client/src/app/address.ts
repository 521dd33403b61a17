// The page's address holds what was chosen by hand, so that a reload and a copied address keep it.

import { setParameters } from "../ui/share_link";

const kTokenField = "token=";

type PageAddress = Pick<Location, "pathname" | "search">;

/** /pad, or ?pad where the server does not know that path. */
export function isPadAddress({ pathname, search }: PageAddress): boolean {
  return pathname.endsWith("/pad") || new URLSearchParams(search).has("pad");
}

/** ?class: the page is shown to a class by a projector. */
export function isProjectorAddress({ search }: Pick<PageAddress, "search">): boolean {
  return new URLSearchParams(search).has("class");
}

/** ?embed: another page shows this one in a frame. */
export function isEmbeddedAddress({ search }: Pick<PageAddress, "search">): boolean {
  return new URLSearchParams(search).has("embed");
}

/** ?kiosk: the page is an exhibit that nobody attends. */
export function isKioskAddress({ search }: Pick<PageAddress, "search">): boolean {
  return new URLSearchParams(search).has("kiosk");
}

/** Browsers refuse pages that change their address more often than 100 times in 30 s. */
const kAddressEveryMs = 400;
const changes = new Map<string, string | undefined>();
let writtenMs = -kAddressEveryMs;
let writing: number | undefined;

/** `value` undefined: the default, which the address leaves out. Changes in quick succession are written together. The address in a frame
 *  belongs to the page around it and stays, and that of a kiosk is what it was set up with. */
export function setAddressParameter(name: string, value: string | undefined): void {
  if (isEmbeddedAddress(location) || isKioskAddress(location)) return;
  changes.set(name, value);
  const waitMs = writtenMs + kAddressEveryMs - performance.now();
  if (waitMs <= 0) writeAddress();
  else writing ??= window.setTimeout(writeAddress, waitMs);
}

/** Returns the page's address with the changes that waited. */
export function currentAddress(): string {
  window.clearTimeout(writing);
  if (changes.size > 0) writeAddress();
  return location.href;
}

function writeAddress(): void {
  writing = undefined;
  writtenMs = performance.now();
  const url = new URL(location.href);
  setParameters(url, changes);
  changes.clear();
  history.replaceState(null, "", url);
}

/** Returns the token of a link, `#token=…`, and removes it from the address, so that it gets into no bookmark and no copied address; undefined
 *  without one. Browsers send the fragment of an address to nobody. */
export function takeLinkToken(location: Pick<Location, "href">, history: Pick<History, "replaceState">): string | undefined {
  const url = new URL(location.href);
  const parts = url.hash.slice(1).split("&");
  const token = parts.find((part) => part.startsWith(kTokenField))?.slice(kTokenField.length);
  if (!token) return undefined;
  url.hash = parts.filter((part) => !part.startsWith(kTokenField)).join("&");
  history.replaceState(null, "", url);
  try {
    return decodeURIComponent(token);
  } catch {
    return token; // A "%" that is not an escape: the server says what it thinks of it.
  }
}
