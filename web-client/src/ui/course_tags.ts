// Numbers over the marks of the course; the next one of one's own boat stands out. Hidden from screen readers, as the boats' names are.
import { Matrix4, type PerspectiveCamera } from "three";

import type { CourseMark } from "../codec/course";
import type { PixelRect } from "../scene/camera/framing";
import { make } from "./dom";
import { tagPlace } from "./tag_place";

export class CourseTags {
  private readonly element = make("div", { class: "course-tags", "aria-hidden": "true", "data-testid": "course-tags" });
  private marks: readonly CourseMark[] = [];
  private labels: HTMLElement[] = [];
  private readonly seen = new Matrix4();

  /** `before`: the tags lie over this element and under everything after it; `topM`: height of a mark over the water. */
  constructor(
    before: Element,
    private readonly topM: (mark: CourseMark) => number,
  ) {
    before.after(this.element);
  }

  enter(marks: readonly CourseMark[]): void {
    this.marks = marks;
    this.labels = marks.map((_, n) => make("span", { hidden: "" }, [String(n + 1)]));
    this.element.replaceChildren(...this.labels);
  }

  /** Called for each picture. `next`: index of the mark that one's own boat has to round. */
  update(camera: PerspectiveCamera, next: number | undefined, heightAtM: (xM: number, zM: number) => number, covered: readonly PixelRect[]): void {
    if (this.marks.length === 0) return;
    this.seen.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    this.marks.forEach((mark, n) => {
      const label = this.labels[n]!;
      const place = tagPlace(this.seen, [mark.xM, heightAtM(mark.xM, mark.zM) + 1.15 * this.topM(mark), mark.zM], window.innerWidth, window.innerHeight, covered);
      label.hidden = place === undefined;
      if (!place) return;
      label.classList.toggle("next", n === next);
      label.style.transform = `translate(${place.xPx.toFixed(1)}px, ${place.yPx.toFixed(1)}px) translate(-50%, -100%)`;
    });
  }
}
