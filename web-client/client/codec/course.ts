// Where boats race and goals are, as plain data that survives postMessage.
import type { Course, CourseGoal as WireGoal } from "../gen/spindrift/v1/scene_pb";

/** As the server allows; the rest is not drawn. */
const kMarksMax = 16;

export interface CourseMark {
  xM: number;
  zM: number;
  /** A boat whose middle comes this close has passed the mark. */
  radiusM: number;
}

/** A rectangle on the water, along the axes. */
export interface CourseGoal {
  xM: number;
  zM: number;
  /** Along x. */
  lengthM: number;
  /** Along z. */
  widthM: number;
}

export interface CourseInfo {
  /** In the order of a lap. */
  marks: CourseMark[];
  /** Each team defends its own; undefined: no ball game. */
  goals: { red: CourseGoal; blue: CourseGoal } | undefined;
}

const isSize = (value: number): boolean => value > 0 && value <= 1e6;
const isPlace = (value: number): boolean => Math.abs(value) <= 1e6;

function readGoal(goal: WireGoal | undefined): CourseGoal | undefined {
  const { xM = 0, zM = 0, lengthM = 2, widthM = 6 } = goal ?? { lengthM: 0 };
  return isPlace(xM) && isPlace(zM) && isSize(lengthM) && isSize(widthM) ? { xM, zM, lengthM, widthM } : undefined;
}

/** Leaves out what cannot be drawn: all marks or both goals. */
export function readCourse({ marks, redGoal, blueGoal }: Course): CourseInfo {
  const read = marks.slice(0, kMarksMax).map(({ xM = 0, zM = 0, radiusM = 4 }) => ({ xM, zM, radiusM }));
  const areMarks = read.every(({ xM, zM, radiusM }) => isPlace(xM) && isPlace(zM) && isSize(radiusM));
  const [red, blue] = [readGoal(redGoal), readGoal(blueGoal)];
  return { marks: areMarks ? read : [], goals: red && blue && { red, blue } };
}
