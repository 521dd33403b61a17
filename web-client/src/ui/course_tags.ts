// Labels over the course: numbers over its marks, of which the next one of one's own boat stands out, and whose a goal is. A game shows those
// that it needs. Hidden from screen readers, as the boats' names are.
import { Matrix4, type PerspectiveCamera } from "three";

import type { CourseInfo, CourseMark } from "../../client/codec/course";
import type { GameInfo } from "../../client/codec/game";
import type { PixelRect } from "../scene/camera/framing";
import { make } from "./dom";
import { kTeamColors } from "./game_texts";
import { tagPlace } from "./tag_place";
import { kTexts } from "./texts";

/** Height of a goal's label over the water, in lengths of its longer side. */
const kGoalTopSides = 0.08;

interface Tag {
  label: HTMLElement;
  /** Shown in this game, and outside of games. */
  kind: GameInfo["kind"];
  xM: number;
  zM: number;
  topM: number;
}

export class CourseTags {
  private readonly element = make("div", { class: "course-tags", "aria-hidden": "true", "data-testid": "course-tags" });
  private tags: Tag[] = [];
  private kind: GameInfo["kind"] | undefined;
  private readonly seen = new Matrix4();

  /** `before`: the tags lie over this element and under everything after it; `topM`: height of a mark over the water. */
  constructor(
    before: Element,
    private readonly topM: (mark: CourseMark) => number,
  ) {
    before.after(this.element);
  }

  /** Labels another course, or none. */
  enter(course: CourseInfo | undefined): void {
    const marks = (course?.marks ?? []).map((mark, n): Tag => ({ ...mark, label: make("span", { hidden: "" }, [String(n + 1)]), kind: "race", topM: 1.15 * this.topM(mark) }));
    const goals = (course?.goals ? (["red", "blue"] as const) : []).map((team): Tag => {
      const { xM, zM, lengthM, widthM } = course!.goals![team];
      const label = make("span", { hidden: "" }, [kTexts.goalOf(team)]);
      label.style.background = kTeamColors[team];
      return { label, kind: "ball", xM, zM, topM: kGoalTopSides * Math.max(lengthM, widthM) };
    });
    this.tags = [...marks, ...goals];
    this.element.replaceChildren(...this.tags.map(({ label }) => label));
  }

  /** The game that is played; undefined: none, and everything is labelled. */
  setGame(kind: GameInfo["kind"] | undefined): void {
    this.kind = kind;
  }

  /** Called for each picture. `next`: index of the mark that one's own boat has to round. */
  update(camera: PerspectiveCamera, next: number | undefined, heightAtM: (xM: number, zM: number) => number, covered: readonly PixelRect[]): void {
    if (this.tags.length === 0) return;
    this.seen.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    this.tags.forEach(({ label, kind, xM, zM, topM }, n) => {
      const isShown = this.kind === undefined || this.kind === kind;
      const place = isShown ? tagPlace(this.seen, [xM, heightAtM(xM, zM) + topM, zM], window.innerWidth, window.innerHeight, covered) : undefined;
      label.hidden = place === undefined;
      if (!place) return;
      label.classList.toggle("next", n === next);
      label.style.transform = `translate(${place.xPx.toFixed(1)}px, ${place.yPx.toFixed(1)}px) translate(-50%, -100%)`;
    });
  }
}
