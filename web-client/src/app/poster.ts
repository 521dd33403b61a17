// A still of the room's scene over the canvas until the first picture is drawn (./dev gallery makes them).

/** Addresses of the stills of shipped scenes. */
const kPosters = import.meta.glob<string>("../posters/*.webp", { query: "?url", import: "default", eager: true });

/** Returns the address of the still of a shipped scene; undefined without one. */
export function posterOf(scene: string | undefined): string | undefined {
  return kPosters[`../posters/${scene}.webp`];
}

/** Shows the poster of a scene over the canvas; without one, nothing. */
export function showPoster(scene: string | undefined): void {
  const poster = document.getElementById("poster") as HTMLImageElement | null;
  const source = posterOf(scene);
  if (!poster || !source) return;
  poster.onload = () => (poster.hidden = false);
  poster.src = source;
}

/** Removes the poster: the water is drawn. The panels follow in the next frame, so that the browser does not paint them first. */
export function removePoster(): void {
  const poster = document.getElementById("poster");
  if (!poster) return;
  poster.remove();
  requestAnimationFrame(showPanels);
}

/** Shows the panels, which wait for the first picture. */
export function showPanels(): void {
  document.body.classList.remove("starting");
}
