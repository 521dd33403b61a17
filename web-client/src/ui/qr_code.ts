// Draws a text as a QR code. Import it only from modules that are loaded when they are used: the library is not small.
import { generate } from "lean-qr";

/** Modules of the quiet zone that readers of QR codes need. */
const kQuietModules = 4;

/** Draws one pixel per module; style the canvas with `image-rendering: pixelated`. Throws if the text is too long for any QR code. */
export function drawQrCode(canvas: HTMLCanvasElement, text: string): void {
  generate(text).toCanvas(canvas, { pad: kQuietModules, on: [0, 0, 0], off: [255, 255, 255] });
}
