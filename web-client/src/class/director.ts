// Chooses what a projector's camera looks at: the whole water while it is calm, the leaders of a race, the ball, or where most is going on.
// Pure: the camera's moves follow from time and what is seen.
import type { GameInfo } from "../../client/codec/game";
import { clamp, smoothstep } from "../scene/maths/interpolate";

/** A shot lasts at least so long, unless the game changes. */
const kLeastShotS = 8;
/** Where most is going on is looked at for so long, then everybody is seen. */
const kLongestShotS = 18;
const kWideShotS = 10;
/** A shot moves into the next one in this time. */
const kMoveS = 3.5;
/** The camera follows what it looks at with this share per second of what is left. */
const kFollowPerS = { centre: 0.9, radius: 0.6 };
/** Most boats of a race that are followed. */
const kLeadersCount = 3;
/** Shares of the water's shorter side: least radius of a shot, room round what it shows, and how far apart activity is one place. */
const kLeastRadiusSides = 0.16;
const kRoomSides = 0.07;
const kNearSides = 0.22;
/** Things count as moving above this speed [m/s]. */
const kMovingMps = 0.4;

interface Place {
  xM: number;
  zM: number;
}

/** What the director sees of the room at a moment. */
export interface Sight {
  nowS: number;
  sideM: number;
  widthM: number;
  boats: readonly (Place & { boatId: number; speedMps: number })[];
  /** Boats of the racers, best first. */
  racerBoatIds: readonly number[];
  fingers: readonly Place[];
  /** Objects that somebody holds, and those that fly or drift quickly. */
  movedFloaters: readonly Place[];
  /** Where waves stand out most, if anywhere. */
  splash: Place | undefined;
  game: GameInfo | undefined;
  ball: Place | undefined;
  /** Marks of the course. */
  marks: readonly Place[];
  /** Goals of the course. */
  goals: readonly Place[];
}

type ShotName = "wide" | "start" | "leaders" | "winner" | "ball" | "action";

/** A disc of the water that the picture has to show. */
interface Framing extends Place {
  radiusM: number;
}

export interface DirectorState {
  shot: ShotName;
  sinceS: number;
  /** What the camera shows now. */
  now: Framing;
  atS: number;
}

/** The whole water. */
export function wideFraming({ sideM, widthM }: Pick<Sight, "sideM" | "widthM">): Framing {
  return { xM: 0, zM: 0, radiusM: Math.hypot(sideM, widthM) / 2 };
}

export function beginDirecting(sight: Sight): DirectorState {
  return { shot: "wide", sinceS: sight.nowS, now: wideFraming(sight), atS: sight.nowS };
}

/** Returns the state for this moment. */
export function direct(state: DirectorState, sight: Sight): DirectorState {
  const shot = wantedShot(state, sight);
  const sinceS = shot === state.shot ? state.sinceS : sight.nowS;
  const goal = framingOf(shot, sight) ?? wideFraming(sight);
  const elapsedS = clamp(sight.nowS - state.atS, 0, 0.5);
  // In the move the camera follows more loosely, so that it begins and ends gently.
  const ease = 0.25 + 1.75 * smoothstep(0, kMoveS, sight.nowS - sinceS);
  const follow = (perS: number): number => 1 - Math.exp(-perS * ease * elapsedS);
  const now = {
    xM: state.now.xM + (goal.xM - state.now.xM) * follow(kFollowPerS.centre),
    zM: state.now.zM + (goal.zM - state.now.zM) * follow(kFollowPerS.centre),
    radiusM: state.now.radiusM + (goal.radiusM - state.now.radiusM) * follow(kFollowPerS.radius),
  };
  return { shot, sinceS, now, atS: sight.nowS };
}

/** Shots of games come at once; others when the shot before has lasted long enough. */
function wantedShot({ shot, sinceS }: DirectorState, sight: Sight): ShotName {
  const lastedS = sight.nowS - sinceS;
  const game = gameShot(sight);
  if (game && framingOf(game, sight)) return game === shot || lastedS >= kLeastShotS || !isGameShot(shot) || game === "winner" ? game : shot;
  if (isGameShot(shot)) return "wide";
  const isThere = framingOf("action", sight) !== undefined;
  if (shot === "action") return lastedS >= kLongestShotS || (!isThere && lastedS >= kLeastShotS) ? "wide" : "action";
  return isThere && lastedS >= kWideShotS ? "action" : "wide";
}

function isGameShot(shot: ShotName): boolean {
  return shot !== "wide" && shot !== "action";
}

function gameShot({ game }: Sight): ShotName | undefined {
  if (!game) return undefined;
  if (game.kind === "ball") return game.phase === "over" ? undefined : "ball";
  return game.phase === "countdown" ? "start" : game.phase === "running" ? "leaders" : "winner";
}

/** Returns what a shot shows now; undefined if there is nothing to see. */
function framingOf(shot: ShotName, sight: Sight): Framing | undefined {
  const boatOf = (boatId: number | undefined): Place | undefined => sight.boats.find((boat) => boat.boatId === boatId);
  const present = (places: (Place | undefined)[]): Place[] => places.filter((place) => place !== undefined);
  switch (shot) {
    case "wide":
      return wideFraming(sight);
    case "start":
      return around(present([...sight.racerBoatIds.map(boatOf), sight.racerBoatIds.length > 0 ? sight.marks[0] : undefined]), sight);
    case "leaders": {
      const unfinished = sight.racerBoatIds.filter((_, n) => sight.game?.racers[n]?.finishedS === 0);
      const leaders = present((unfinished.length > 0 ? unfinished : sight.racerBoatIds).slice(0, kLeadersCount).map(boatOf));
      const first = sight.game?.racers.find(({ finishedS }) => finishedS === 0);
      const mark = first && leaders.length > 0 ? sight.marks[first.nextMark] : undefined;
      return around(present([...leaders, mark && nearTo(leaders[0]!, mark, sight)]), sight);
    }
    case "winner":
      return around(present([boatOf(sight.racerBoatIds[0])]), sight);
    // With both goals: who sees the ball alone does not know where it has to go.
    case "ball":
      return sight.ball && around([sight.ball, ...near(sight.ball, sight.boats, sight), ...sight.goals], sight);
    case "action": {
      const busy = busiest(sight);
      return busy && around(busy, sight);
    }
  }
}

/** The mark that is raced for, as far as it does not make the boats small. */
function nearTo(boat: Place, mark: Place, { sideM, widthM }: Sight): Place {
  const wayM = Math.hypot(mark.xM - boat.xM, mark.zM - boat.zM);
  const share = Math.min(1, (0.3 * Math.min(sideM, widthM)) / Math.max(wayM, 1e-6));
  return { xM: boat.xM + share * (mark.xM - boat.xM), zM: boat.zM + share * (mark.zM - boat.zM) };
}

function near(middle: Place, places: readonly Place[], { sideM, widthM }: Sight): Place[] {
  const withinM = kNearSides * Math.min(sideM, widthM);
  return places.filter(({ xM, zM }) => Math.hypot(xM - middle.xM, zM - middle.zM) < withinM);
}

/** Returns the places round the one with the most others near it; undefined if nobody does anything, or everybody everywhere. */
function busiest(sight: Sight): Place[] | undefined {
  const places = [...sight.fingers, ...sight.movedFloaters, ...sight.boats.filter(({ speedMps }) => Math.abs(speedMps) > kMovingMps), ...(sight.splash ? [sight.splash] : [])];
  let most: Place[] = [];
  for (const place of places) {
    const group = near(place, places, sight);
    if (group.length > most.length) most = group;
  }
  return most.length > 0 ? most : undefined;
}

/** The least disc about the middle of places with room round them; undefined without places. */
function around(places: readonly Place[], { sideM, widthM }: Sight): Framing | undefined {
  if (places.length === 0) return undefined;
  const middle = (of: (place: Place) => number): number => (Math.min(...places.map(of)) + Math.max(...places.map(of))) / 2;
  const [xM, zM] = [middle((place) => place.xM), middle((place) => place.zM)];
  const shortM = Math.min(sideM, widthM);
  const reachM = Math.max(...places.map((place) => Math.hypot(place.xM - xM, place.zM - zM)));
  return { xM, zM, radiusM: Math.max(reachM + kRoomSides * shortM, kLeastRadiusSides * shortM) };
}
