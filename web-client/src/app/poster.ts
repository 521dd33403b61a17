// A still of the room's scene over the canvas until the first picture is drawn (./dev gallery makes them).

/** Addresses of the stills of shipped scenes. */
const kPosters = import.meta.glob<string>("../posters/*.webp", { query: "?url", import: "default", eager: true });

/** Shows the poster of the address's scene, or of the room's if the server tells it; without one, nothing. */
export async function showPoster(): Promise<void> {
  const poster = document.getElementById("poster") as HTMLImageElement | null;
  const source = kPosters[`../posters/${await sceneOf(new URLSearchParams(location.search))}.webp`];
  if (!poster || !source) return;
  poster.onload = () => (poster.hidden = false);
  poster.src = source;
}

async function sceneOf(parameters: URLSearchParams): Promise<string | undefined> {
  const scene = parameters.get("scene");
  // With a token in the link, the server may tell nothing without it.
  if (scene !== null || location.hash) return scene ?? undefined;
  const answer = await fetch("./api/v1/rooms").catch(() => undefined);
  if (!answer?.ok) return undefined;
  const { rooms = [] } = (await answer.json()) as { rooms?: { name: string; scene: string }[] };
  return rooms.find(({ name }) => name === (parameters.get("room") || "main"))?.scene;
}

/** Removes the poster: the water is drawn. */
export function removePoster(): void {
  document.getElementById("poster")?.remove();
}
