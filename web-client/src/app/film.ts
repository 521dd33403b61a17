// A film of the canvas, encoded by the browser (WebCodecs) and written by mediabunny: MP4 with H.264 where the browser has it, else WebM.
import { BufferTarget, CanvasSource, getFirstEncodableVideoCodec, Mp4OutputFormat, Output, QUALITY_HIGH, WebMOutputFormat } from "mediabunny";

const kPicturesPerS = 30;
/** H.264 has even sizes only. */
const even = (px: number): number => 2 * Math.max(Math.floor(px / 2), 1);

/** Begins a film in the present size of the canvas; undefined where the browser encodes no codec of a film. */
export async function beginFilm(canvas: HTMLCanvasElement): Promise<Film | undefined> {
  const size = { width: even(canvas.width), height: even(canvas.height) };
  const codec = await getFirstEncodableVideoCodec(["avc", "vp9", "vp8"], { ...size, quality: QUALITY_HIGH });
  if (!codec) return undefined;
  const format = codec === "avc" ? new Mp4OutputFormat({ fastStart: "in-memory" }) : new WebMOutputFormat();
  const output = new Output({ format, target: new BufferTarget() });
  // The canvas changes its size with the window and with the drawing's quality.
  const source = new CanvasSource(canvas, { codec, quality: QUALITY_HIGH, sizeChangeBehavior: "contain", transform: size });
  output.addVideoTrack(source, { frameRate: kPicturesPerS });
  await output.start();
  return new Film(output, source);
}

export class Film {
  readonly extension: string;
  lengthS = 0;
  /** Why no more pictures are taken; undefined while all is well. */
  problem: unknown;
  private beginS: number | undefined;
  /** Number of the next picture, of so many per second. */
  private next = 0;
  private adding: Promise<void> | undefined;

  constructor(
    private readonly output: Output<Mp4OutputFormat | WebMOutputFormat, BufferTarget>,
    private readonly source: CanvasSource,
  ) {
    this.extension = output.format.fileExtension.slice(1);
  }

  /** Takes the picture on the canvas, if one is due; left out while the encoder is behind. Call it in the task that has drawn. */
  take(atS: number): void {
    this.beginS ??= atS;
    this.lengthS = atS - this.beginS;
    const number = Math.floor(this.lengthS * kPicturesPerS);
    if (number < this.next || this.adding || this.problem) return;
    this.next = number + 1;
    this.adding = this.source
      .add(number / kPicturesPerS, 1 / kPicturesPerS)
      .catch((error: unknown) => (this.problem = error))
      .then(() => (this.adding = undefined));
  }

  /** Ends the film and returns the file; rejects with the problem if there was one. */
  async end(): Promise<Blob> {
    await this.adding;
    if (this.problem) {
      await this.output.cancel();
      throw this.problem;
    }
    await this.output.finalize();
    return new Blob([this.output.target.buffer!], { type: this.output.format.mimeType });
  }
}
