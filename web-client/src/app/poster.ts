// A still of the room's scene over the canvas until the first picture is drawn (./dev gallery makes them).

import { roomOf, wishOf } from "../net/room_address";

/** The room of an address that names none, as in the server. */
const kFirstRoom = "main";
/** Addresses of the stills of shipped scenes. */
const kPosters = import.meta.glob<string>("../posters/*.webp", { query: "?url", import: "default", eager: true });

/** Returns the address of the still of a shipped scene; undefined without one. */
export function posterOf(scene: string | undefined): string | undefined {
  return kPosters[`../posters/${scene}.webp`];
}

/** Shows the poster of the room's scene, or of the scene with which the address opens it; without a poster, nothing. */
export async function showPoster(): Promise<void> {
  const poster = document.getElementById("poster") as HTMLImageElement | null;
  const source = posterOf(await sceneOf(location.search));
  if (!poster || !source) return;
  poster.onload = () => (poster.hidden = false);
  poster.src = source;
}

async function sceneOf(search: string): Promise<string | undefined> {
  const wanted = wishOf(search)?.scene;
  // With a token in the link, the server may tell nothing without it.
  const answer = location.hash ? undefined : await fetch("./api/v1/rooms").catch(() => undefined);
  if (!answer?.ok) return wanted;
  const { rooms = [] } = (await answer.json()) as { rooms?: { name: string; scene: string }[] };
  return rooms.find(({ name }) => name === (roomOf(search) || kFirstRoom))?.scene ?? wanted;
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
