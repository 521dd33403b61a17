// What a picture is drawn by: a list of passes (room_passes.ts). Each draws what it writes from what it reads, and owns what it writes.
import type { PerspectiveCamera, Vector2, WebGLRenderer } from "three";

/** What passes hand on to each other. */
export type Resource =
  /** The server's frames around the time shown. */
  | "frames"
  /** Where the water stands against hulls. */
  | "waterlines"
  /** Elevation, slopes and curvature of the simulated water. */
  | "field"
  /** Sunlight that the waves focus below them. */
  | "caustics"
  /** What the sun or the moon sees of solids. */
  | "shadow"
  /** Depth at the waterline, wetness of the ground, foam of the swash. */
  | "shore"
  /** Foam of the simulated water. */
  | "foam"
  /** Drops, foam and bubbles that the page adds. */
  | "whitewater"
  /** Their foam as a texture over the water. */
  | "froth"
  /** Slopes of the rings of rain, as a repeating tile. */
  | "rain"
  /** Elevation and slopes of the sea around it. */
  | "sea"
  /** Colour (linear light) and depth of everything but water. */
  | "solids"
  /** The particles, on the GPU. */
  | "particles"
  /** Tiles of the screen with particles. */
  | "fluidTiles"
  /** The floor under a tank of particles, seen from above. */
  | "fluidFloor"
  /** Density of the particles in cells, and the white share of it. */
  | "fluidVolume"
  /** The value that a look shows on the surface. */
  | "lookValue"
  /** Colours for the display, and depth. */
  | "canvas";

/** One picture, as every pass takes it. The next picture overwrites it. */
export interface Picture {
  readonly renderer: WebGLRenderer;
  readonly camera: PerspectiveCamera;
  /** Size of the canvas. */
  readonly sizePx: Vector2;
  /** Time shown, in seconds since the scene began; undefined before the first frame. */
  shownS: number | undefined;
}

export interface Pass {
  readonly name: string;
  readonly reads: readonly Resource[];
  readonly writes: readonly Resource[];
  draw(picture: Picture): void;
  /** Takes over from a picture, without drawing it, what later pictures need of it; left out where they need nothing. */
  remember?(picture: Picture): void;
  dispose(): void;
}
