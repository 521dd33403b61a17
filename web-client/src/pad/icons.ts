// Pictures on the pad's buttons, one stroke each, in a square of 24.
import type { LessonTool } from "../../client/codec/lesson";
import { makeIcon } from "../ui/dom";

const kPaths: Record<LessonTool, string> = {
  finger: "M9 21l-4-6 2-1 2 2V5a1.5 1.5 0 0 1 3 0v6l5 1.2a2 2 0 0 1 1.5 2.3L17.5 21z",
  splash: "M12 4c3 4 4 5.5 4 7.5a4 4 0 0 1-8 0C8 9.5 9 8 12 4zM3 19c2-1.5 4-1.5 6 0s4 1.5 6 0 4-1.5 6 0M4 13l-1.5-2M20 13l1.5-2",
  wave: "M2 17c4 0 5-10 10-10 4 0 5 3.5 3 5-1.2 1-3 .2-3-1.2M2 17h20M8 17c2-1 2-4 5-6.2",
  rain: "M7 14a4 4 0 0 1 .5-8 5 5 0 0 1 9.5 1.5A3.3 3.3 0 0 1 17 14zM8 17l-1 3M12.5 17l-1 3M17 17l-1 3",
  float: "M6 12V6l6-3 6 3v6l-6 3zM6 6l6 3 6-3M12 9v6M2 19c2.5-1.5 4.5-1.5 7 0s4.5 1.5 7 0 4.5-1.5 6-.5",
  throw: "M4 18C6 9 12 6 18 9M18 9l-4.5-.5M18 9l-2 4M3 21h18M19 15.5a1.5 1.5 0 1 0 .01 0",
  boat: "M3 14h18l-3 5H7zM11 14V3l7 8h-7M9 14V7l-4 5",
};

export const toolIcon = (tool: LessonTool): SVGSVGElement => makeIcon(kPaths[tool]);
