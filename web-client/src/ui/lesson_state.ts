// What the server has said of lesson, game and people, and what follows for this visitor. Page, projector and pad share it.
import type { GameInfo } from "../../client/codec/game";
import { kFreeLesson, type LessonInfo, type LessonTool } from "../../client/codec/lesson";
import type { PersonInfo, RoleName } from "../../client/codec/people";
import type { ToolName } from "./tools";
import { kTexts } from "./texts";

/** What the server asks the lesson for when a tool of the page is used; undefined: for nothing. */
const kLessonTools: Record<ToolName, LessonTool | undefined> = { finger: "finger", splash: "splash", paddle: "wave", rain: "rain", calm: undefined, float: "float", throw: "throw" };

export function lessonToolOf(tool: ToolName): LessonTool | undefined {
  return kLessonTools[tool];
}

interface Rules {
  lesson: LessonInfo;
  role: RoleName;
  /** The operator has muted this visitor. */
  isMuted: boolean;
}

/** Returns why a player may not use a tool now, as a line for people; undefined if nothing is against it. */
export function whyNot(tool: LessonTool | undefined, { lesson, role, isMuted }: Rules): string | undefined {
  if (role === "operator") return undefined;
  if (lesson.frozen) return kTexts.teacherPaused;
  if (isMuted) return kTexts.teacherMuted;
  if (tool !== undefined && !lesson.tools.includes(tool)) return kTexts.notHandedOut(kTexts.lessonTools[tool]);
  return undefined;
}

export class LessonState {
  lesson: LessonInfo = kFreeLesson;
  game: GameInfo | undefined;
  people: readonly PersonInfo[] = [];
  role: RoleName = "viewer";
  ownId = 0;
  private readonly watchers: (() => void)[] = [];

  /** Calls back after every change. */
  watch(changed: () => void): void {
    this.watchers.push(changed);
  }

  set(change: Partial<Pick<LessonState, "lesson" | "game" | "people" | "role" | "ownId">>): void {
    Object.assign(this, change);
    for (const changed of this.watchers) changed();
  }

  /** Forgets the rules of another room; those of this one come after its greeting. */
  enter(): void {
    this.set({ lesson: kFreeLesson, game: undefined });
  }

  get me(): PersonInfo | undefined {
    return this.personOf(this.ownId);
  }

  personOf(personId: number): PersonInfo | undefined {
    return this.people.find((person) => person.personId === personId);
  }

  /** Returns why this visitor may not use a tool now; undefined if nothing is against it. */
  whyNot(tool: LessonTool | undefined): string | undefined {
    return whyNot(tool, { lesson: this.lesson, role: this.role, isMuted: this.me?.muted === true });
  }
}
