// Fullscreen, and the picture of the canvas as a file: one as PNG, or a film. What encodes films is loaded when the first one begins.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { ActionButton, PageActions } from "../ui/page_actions";
import { kTexts } from "../ui/texts";
import type { Display } from "./display";
import type { Film } from "./film";
import { fileName, saveFile } from "./saved_file";

/** A film ends by itself then: it is kept in memory until it is saved. */
const kFilmLongestS = 60;

export class PictureControls {
  private readonly filmButton: ActionButton;
  private sceneName = "";
  private wantsPicture = false;
  private film: Film | undefined;
  private isBusy = false;

  /** `failed`: shows why something did not work. */
  constructor(
    private readonly display: Display,
    private readonly actions: PageActions,
    private readonly failed: (why: string) => void,
  ) {
    this.addFullscreen();
    this.actions.add("picture", "picture", kTexts.picture, () => (this.wantsPicture = true));
    this.filmButton = this.actions.add("film", "film", kTexts.film(kFilmLongestS), () => void (this.film ? this.endFilm() : this.beginFilm()));
  }

  enter({ sceneName, room }: GreetingInfo): void {
    this.sceneName = sceneName || room;
  }

  /** Call it after each picture, in the same task: the canvas can be read until it ends. */
  drawn(): void {
    if (this.wantsPicture) this.takePicture();
    const { film } = this;
    if (!film) return;
    film.take(performance.now() / 1000);
    this.filmButton.show(kTexts.endFilm, true, `${Math.floor(film.lengthS)} s`);
    if (film.lengthS >= kFilmLongestS || film.problem) void this.endFilm();
  }

  private addFullscreen(): void {
    if (!document.fullscreenEnabled) return;
    const root = document.documentElement;
    const button = this.actions.add("fullscreen", "fullscreen", kTexts.fullscreen, () => {
      const change = document.fullscreenElement ? document.exitFullscreen() : root.requestFullscreen();
      change.catch((error: unknown) => this.failed(kTexts.fullscreenFailed(reasonOf(error))));
    });
    document.addEventListener("fullscreenchange", () => {
      const isFull = document.fullscreenElement !== null;
      button.show(isFull ? kTexts.leaveFullscreen : kTexts.fullscreen, isFull);
    });
  }

  private takePicture(): void {
    this.wantsPicture = false;
    const name = fileName(this.sceneName, "png", new Date());
    // Drawn once more, with all pixels of the screen.
    this.display.drawInFull((canvas) =>
      canvas.toBlob((blob) => (blob ? saveFile(blob, name) : this.failed(kTexts.pictureFailed(kTexts.pixels(canvas.width, canvas.height)))), "image/png"),
    );
  }

  private async beginFilm(): Promise<void> {
    if (this.isBusy) return;
    if (typeof VideoEncoder === "undefined") return this.failed(window.isSecureContext ? kTexts.filmHasNoCodec : kTexts.filmNeedsHttps);
    this.isBusy = true;
    try {
      const { beginFilm } = await import("./film");
      this.film = await beginFilm(this.display.canvas);
      if (!this.film) this.failed(kTexts.filmHasNoCodec);
    } catch (error) {
      this.failed(kTexts.filmFailed(reasonOf(error)));
    } finally {
      this.isBusy = false;
    }
  }

  private async endFilm(): Promise<void> {
    const film = this.film!;
    this.film = undefined;
    this.filmButton.show(kTexts.film(kFilmLongestS), false);
    try {
      const blob = await film.end();
      saveFile(blob, fileName(this.sceneName, film.extension, new Date()));
    } catch (error) {
      this.failed(kTexts.filmFailed(reasonOf(error)));
    }
  }
}

function reasonOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
