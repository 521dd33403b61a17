// The attributes of <spindrift-water>, and the address of the page that its frame shows.

/** Attributes that are parameters of the page's address under the same name (docs/controls.md). */
export const kPageAttributes = ["room", "scene", "view", "camera", "light", "look", "quality", "tool", "panel"] as const;
export type PageAttribute = (typeof kPageAttributes)[number];

/** Returns the address of the page without panels. `server`: of the server's page, `https://HOST/` or `https://HOST/PATH/`. `token`: gives a
 *  role; browsers send it to nobody. Throws when `server` is no http or https address. */
export function frameAddress(server: string, values: Partial<Record<PageAttribute, string>>, token = ""): URL {
  if (!URL.canParse(server) || !/^https?:$/.test(new URL(server).protocol)) throw new Error(`server "${server}" is not an address: write https://HOST/`);
  const url = new URL(server);
  if (!url.pathname.endsWith("/")) url.pathname += "/";
  const parameters = new URLSearchParams();
  for (const name of kPageAttributes) {
    const value = values[name];
    if (value !== undefined) parameters.set(name, value);
  }
  url.search = `?embed${parameters.size > 0 ? `&${parameters}` : ""}`;
  url.hash = token === "" ? "" : `token=${encodeURIComponent(token)}`;
  return url;
}
