// Files that the page makes: their names, and the click that saves them.
import { make } from "../ui/dom";

/** The browser reads a file's address some time after the click. */
const kSavedMs = 60_000;

/** Returns a name such as "spindrift-harbor-2026-11-27-183005.png"; `at` in local time. */
export function fileName(sceneName: string, extension: string, at: Date): string {
  const scene = sceneName.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "water";
  // Sweden writes 2026-11-27 18:30:05.
  const when = at.toLocaleString("sv").replaceAll(":", "").replace(" ", "-");
  return `spindrift-${scene}-${when}.${extension}`;
}

/** The browser asks for a folder or takes the usual one, as for every download. */
export function saveFile(blob: Blob, name: string): void {
  const href = URL.createObjectURL(blob);
  make("a", { href, download: name }).click();
  window.setTimeout(() => URL.revokeObjectURL(href), kSavedMs);
}
