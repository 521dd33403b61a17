import { describe, expect, it } from "vitest";

import { readCourse } from "../client/codec/course";
import { kFreeLesson, kLessonToolNames, wireLesson, type LessonInfo } from "../client/codec/lesson";
import { parse } from "../client/codec/parse";
import { CourseSchema } from "../client/gen/spindrift/v1/scene_pb";
import { GameKind, GamePhase, LessonSchema, Team, Tool } from "../client/gen/spindrift/v1/wire_pb";
import { create } from "@bufbuild/protobuf";
import { LessonState, lessonToolOf, whyNot } from "../src/ui/lesson_state";
import { encode } from "./wire";

const me = (change: object) => ({ personId: 4, name: "Ada", color: "#ff0000", role: "player" as const, boatIds: [], away: false, team: undefined, muted: false, ...change });
const rules = (change: object) => ({ lesson: kFreeLesson, role: "player" as const, isMuted: false, ...change });

describe("a lesson in a message", () => {
  it("hands out all tools and full force unless it says otherwise", () => {
    expect(parse(encode({ case: "lesson", value: {} }))).toEqual({ kind: "lesson", lesson: kFreeLesson });
    const few = parse(encode({ case: "lesson", value: { frozen: true, tools: [Tool.BOAT, Tool.FINGER], forceRatio: 0.25, teams: true } }));
    expect(few).toEqual({ kind: "lesson", lesson: { frozen: true, tools: ["finger", "boat"], forceRatio: 0.25, teams: true } });
  });

  it("is malformed with a force that is no share", () => {
    for (const forceRatio of [0, -1, 1.01, NaN, Infinity]) expect(parse(encode({ case: "lesson", value: { forceRatio } })).kind).toBe("malformed");
  });

  it("goes back to the server as it came", () => {
    const lesson: LessonInfo = { frozen: false, tools: ["wave", "boat"], forceRatio: 0.5, teams: true };
    expect(wireLesson(lesson)).toEqual({ frozen: false, tools: [Tool.WAVE, Tool.BOAT], forceRatio: 0.5, teams: true });
    expect(wireLesson(kFreeLesson).tools).toEqual([]);
    expect(parse(encode({ case: "lesson", value: create(LessonSchema, wireLesson(lesson)) }))).toEqual({ kind: "lesson", lesson });
  });
});

describe("a game in a message", () => {
  it("is read with its racers and team, and absent without a kind", () => {
    const racers = [{ personId: 4, lapsCount: 1, nextMark: 2, lapBestS: 31.5, finishedS: 0 }];
    const game = parse(encode({ case: "game", value: { kind: GameKind.RACE, phase: GamePhase.RUNNING, beginsS: 3, lapsCount: 2, racers, winnerTeam: Team.RED } }));
    expect(game).toMatchObject({ kind: "game", game: { kind: "race", phase: "running", beginsS: 3, lapsCount: 2, racers, winnerTeam: "red" } });
    expect(parse(encode({ case: "game", value: {} }))).toEqual({ kind: "game", game: undefined });
    expect(parse(encode({ case: "game", value: { kind: GameKind.BALL, phase: GamePhase.OVER, endsS: NaN } })).kind).toBe("malformed");
  });
});

describe("a course", () => {
  it("has the defaults of the scene, and both goals or none", () => {
    const goal = { xM: 9 };
    expect(readCourse(create(CourseSchema, { marks: [{ xM: 3, zM: -2 }], redGoal: goal, blueGoal: { ...goal, lengthM: 1 } }))).toEqual({
      marks: [{ xM: 3, zM: -2, radiusM: 4 }],
      goals: { red: { xM: 9, zM: 0, lengthM: 2, widthM: 6 }, blue: { xM: 9, zM: 0, lengthM: 1, widthM: 6 } },
    });
    expect(readCourse(create(CourseSchema, { redGoal: goal })).goals).toBeUndefined();
  });

  it("is not drawn with marks that have no position: their order would be another", () => {
    expect(readCourse(create(CourseSchema, { marks: [{ xM: NaN }, { xM: 3 }] })).marks).toEqual([]);
    expect(readCourse(create(CourseSchema, { marks: Array.from({ length: 40 }, () => ({})) })).marks).toHaveLength(16);
  });
});

describe("the rules of a lesson", () => {
  it("name the reason why a tool cannot be used", () => {
    expect(whyNot("wave", rules({}))).toBeUndefined();
    expect(whyNot("wave", rules({ lesson: { ...kFreeLesson, tools: ["finger"] } }))).toBe("Wave: not handed out in this lesson.");
    expect(whyNot("finger", rules({ lesson: { ...kFreeLesson, frozen: true } }))).toMatch(/paused/);
    expect(whyNot(undefined, rules({ isMuted: true }))).toMatch(/muted/);
  });

  it("do not bind operators", () => {
    expect(whyNot("rain", rules({ role: "operator", lesson: { ...kFreeLesson, frozen: true, tools: ["finger"] } }))).toBeUndefined();
  });

  it("know each tool of the page but calm, which is for operators", () => {
    const known = (["finger", "splash", "paddle", "rain", "calm", "float", "throw"] as const).map(lessonToolOf);
    expect(known.filter((tool) => tool === undefined)).toHaveLength(1);
    expect(known.every((tool) => tool === undefined || kLessonToolNames.includes(tool))).toBe(true);
  });

  it("follow people and lesson, and end with the room", () => {
    const state = new LessonState();
    let count = 0;
    state.watch(() => ++count);
    state.set({ role: "player", ownId: 4, people: [me({ muted: true })] });
    expect(state.whyNot("boat")).toMatch(/muted/);
    state.set({ people: [me({})], lesson: { ...kFreeLesson, tools: ["rain"] } });
    expect([state.whyNot("boat") !== undefined, state.whyNot("rain")]).toEqual([true, undefined]);
    state.enter();
    expect(state.whyNot("boat")).toBeUndefined();
    expect(count).toBe(3);
  });
});
