// Addresses that a page shares, made from its own.

/** Sets parameters of an address; empty or undefined takes one away. */
export function setParameters(url: URL, parameters: Iterable<[name: string, value: string | undefined]>): void {
  for (const [name, value] of parameters) {
    if (value) url.searchParams.set(name, value);
    else url.searchParams.delete(name);
  }
  // People read these, and both characters may stand in a query (RFC 3986).
  url.search = url.search.replaceAll("%3A", ":").replaceAll("%2C", ",");
}

/** Returns the page's address as other devices open it, from the address of the pad at which they reach the server. */
export function addressAt(padUrl: string, page: string): string {
  const url = new URL(".", padUrl);
  url.search = new URL(page).search;
  return url.href;
}

/** Returns the page's address with these parameters. A token is in the fragment, which browsers send to nobody; the page's own fragment is left out. */
export function linkWith(page: string, parameters: Record<string, string | undefined>, token: string): string {
  const url = new URL(page);
  setParameters(url, Object.entries(parameters));
  url.hash = token ? `token=${encodeURIComponent(token)}` : "";
  return url.href;
}
