// The HTML that shows a room of this server in another page.
import { kPageAttributes } from "../../element/address";

const kEscapes: Record<string, string> = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };

/** Returns the code for the page at this address: the view, camera, light and all else that the element has an attribute for. A token is left
 *  out: who reads the code would have it. */
export function embedCode(page: string): string {
  const { searchParams } = new URL(page);
  const server = new URL(".", page);
  server.search = server.hash = "";
  const values = kPageAttributes.map((name) => [name, searchParams.get(name)] as const).filter(([, value]) => value !== null);
  const attributes = [["server", server.href] as const, ...values].map(([name, value]) => `${name}="${escaped(value ?? "")}"`);
  return `<script type="module" src="${escaped(new URL("element.js", server).href)}"></script>\n<spindrift-water ${attributes.join(" ")}></spindrift-water>\n`;
}

function escaped(text: string): string {
  return text.replace(/[&<>"]/g, (letter) => kEscapes[letter]!);
}
