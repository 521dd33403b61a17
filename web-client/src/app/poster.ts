// A still of the room's scene over the canvas until the first picture is drawn (./dev gallery makes them).

/** Addresses of the stills of shipped scenes. */
const kPosters = import.meta.glob<string>("../posters/*.webp", { query: "?url", import: "default", eager: true });

/** Shows the poster of the room if the server tells its scene and there is one. */
export async function showPoster(): Promise<void> {
  // With a token in the link, the server may tell nothing without it, and the page takes it out of the address.
  if (location.hash) return;
  const room = new URLSearchParams(location.search).get("room") ?? "main";
  const answer = await fetch(`./api/v1/rooms/${encodeURIComponent(room)}`).catch(() => undefined);
  if (!answer?.ok) return;
  const { scene } = (await answer.json()) as { scene?: string };
  const poster = document.getElementById("poster") as HTMLImageElement | null;
  const source = kPosters[`../posters/${scene}.webp`];
  if (!poster || !source) return;
  poster.onload = () => (poster.hidden = false);
  poster.src = source;
}

/** Removes the poster: the water is drawn. */
export function removePoster(): void {
  document.getElementById("poster")?.remove();
}
