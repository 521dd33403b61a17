// Places a camera so that a whole box is seen inside a part of the canvas. Pure: no DOM, no renderer.
import { Vector3 } from "three";

import type { FirstViewInfo, SideName } from "../../../client/codec/scene_info";
import { clamp } from "../maths/interpolate";

/** A part of the canvas in CSS pixels from its top left corner. */
export interface PixelRect {
  leftPx: number;
  topPx: number;
  rightPx: number;
  bottomPx: number;
}

/** The box that a view shows: a square of `sideM` round the y axis, from `minYM` up to `maxYM`. */
export interface ViewedBox {
  sideM: number;
  minYM: number;
  maxYM: number;
  /** Length along z where it differs. */
  widthM?: number;
  /** Share of the box's sides that has to be seen in a wide and in a tall free part; 1 if left out. The rest may lie outside the picture. */
  focus?: { wide: number; tall: number };
  /** Position of that part's middle in sides of the box, along x and z; the middle of the box if left out. */
  lean?: { x: number; z: number };
  /** Middle of the box if it is not the y axis. */
  centreM?: { x: number; z: number };
  /** Angle about the y axis by which the box's sides are turned, from +x toward +z; 0 if left out. */
  turnRad?: number;
  /** What the scene shows first, instead of what suits its setting. */
  first?: FirstViewInfo;
  /** The scene's first view shows the water down to its floor. */
  withFloor?: boolean;
  /** How much higher than usual the first view looks down in a wide and in a tall free part; the framing's own limits if left out. */
  raised?: { wide: number; tall: number };
  /** How much higher than usual the view from the side looks down, because a rim hides the water from below; 1 if left out. */
  sideRaised?: number;
  /** Side from which the view from the side looks, because no land hides the water there; +z if left out. */
  seenFrom?: SideName;
}

export interface Placement {
  positionM: Vector3;
  /** Straight ahead of the camera, as far away as the box's middle. */
  targetM: Vector3;
}

/** Share of the free part that stays empty on each side. */
const kMargin = 0.035;
/** A free part smaller than this share of the canvas is treated as this large. */
const kMinFreeShare = 0.25;

/** Returns half the free part's width and height as tangents, for a camera whose picture is centred on that part. */
export function freeTangents(fovDegrees: number, heightPx: number, widthPx: number, free: PixelRect): { across: number; up: number } {
  const perPx = Math.tan((fovDegrees * Math.PI) / 360) / heightPx;
  const share = 1 - 2 * kMargin;
  return {
    across: perPx * share * Math.max(free.rightPx - free.leftPx, kMinFreeShare * widthPx),
    up: perPx * share * Math.max(free.bottomPx - free.topPx, kMinFreeShare * heightPx),
  };
}

/** A free part is wide above the first ratio of width to height, and tall below the second. */
const kWideRatio = 1.2;
const kTallRatio = 0.6;
const kRaised = { wide: 1, tall: 2.2 };

/** Returns 0 for a wide free part and 1 for a tall one. */
function tallness(tangents: { across: number; up: number }): number {
  return clamp((kWideRatio - tangents.across / tangents.up) / (kWideRatio - kTallRatio), 0, 1);
}

/** Returns the factor by which a first view is raised in a free part of this shape: a higher camera fills more of a tall one. */
export function raisedBy(box: ViewedBox, tangents: { across: number; up: number }): number {
  const { wide, tall } = box.raised ?? kRaised;
  return wide + (tall - wide) * tallness(tangents);
}

/** Returns the part of the box that has to be seen in a free part of this shape. */
export function focusBox(box: ViewedBox, tangents: { across: number; up: number }): ViewedBox {
  if (!box.focus) return box;
  const share = box.focus.wide + (box.focus.tall - box.focus.wide) * tallness(tangents);
  const widthM = box.widthM ?? box.sideM;
  const lean = box.lean ?? { x: 0, z: 0 };
  const centreM = { x: lean.x * box.sideM, z: lean.z * widthM };
  return { ...box, sideM: share * box.sideM, widthM: share * widthM, centreM };
}

/** In a tall free part, a scene's first view shows this share of its side across, around its subject, and looks down with this multiple of its slope. */
const kFirstTall = { across: 0.55, slope: 1.5 };
/** Depth of water that it shows, as a share of its side across. */
const kFirstDepth = 0.3;

/** Returns the part of the water that a scene shows first, and the direction to the camera, in a free part of this shape. */
export function firstView(box: ViewedBox, first: FirstViewInfo, tangents: { across: number; up: number }): { box: ViewedBox; backward: Vector3 } {
  const tall = tallness(tangents);
  const whole = focusBox(box, tangents);
  const acrossM = first.acrossM > 0 ? first.acrossM * (1 + (kFirstTall.across - 1) * tall) : Math.max(whole.sideM, whole.widthM ?? 0);
  const { headingRad } = first;
  const rightM = tall * first.subjectRightM;
  const centreM = { x: first.xM - rightM * Math.sin(headingRad), z: first.zM + rightM * Math.cos(headingRad) };
  const pitchRad = Math.atan(Math.tan(first.pitchRad) * (1 + (kFirstTall.slope - 1) * tall));
  // Deep water is seen without its floor.
  const minYM = box.withFloor ? box.minYM : Math.max(box.minYM, -kFirstDepth * acrossM);
  const { maxYM } = box;
  return {
    box: { sideM: first.awayM || acrossM, widthM: acrossM, minYM, maxYM, centreM, turnRad: headingRad },
    backward: new Vector3(-Math.cos(headingRad) * Math.cos(pitchRad), Math.sin(pitchRad), -Math.sin(headingRad) * Math.cos(pitchRad)),
  };
}

/** Returns a direction to the camera that looks down by at least this angle. */
export function raisedTo(pitchRad: number, { x, y, z }: Vector3): Vector3 {
  return new Vector3(x, Math.max(y, Math.tan(pitchRad) * Math.hypot(x, z)), z);
}

/** Unit vectors out of the sides, along x and z. */
const kOutward: Record<SideName, readonly [number, number]> = { "+x": [1, 0], "-x": [-1, 0], "+z": [0, 1], "-z": [0, -1] };

/** Returns a direction that was given for a camera at the side +z, turned about the y axis to another side. */
export function turnedTo(side: SideName, direction: Vector3): Vector3 {
  const [x, z] = kOutward[side];
  return new Vector3(z * direction.x + x * direction.z, direction.y, z * direction.z - x * direction.x);
}

/** Corners along one axis of the picture, in the camera's axes: sideways and toward the camera. */
type AxisCorners = [sidewaysM: number, towardM: number][];

/**
 * Returns the least distance at which all corners lie within ±`tangent`, and the sideways position of the camera there.
 *
 * A corner (x, z) seen from (c, d) is inside the right edge if x - c <= t (d - z), that is c + t d >= x + t z, and
 * likewise at the left edge. The corner with the largest bound decides at each edge; the two bounds give d and c.
 */
function fitAxis(corners: AxisCorners, tangent: number): { distanceM: number; sidewaysM: number } {
  const right = Math.max(...corners.map(([x, z]) => x + tangent * z));
  const left = Math.max(...corners.map(([x, z]) => -x + tangent * z));
  return { distanceM: (right + left) / (2 * tangent), sidewaysM: (right - left) / 2 };
}

/** Returns the sideways position that centres the corners seen from `distanceM`, where they fill less than ±`tangent`. */
function centreAxis(corners: AxisCorners, tangent: number, distanceM: number): number {
  // A smaller tangent needs a greater distance: bisect for the tangent that needs exactly `distanceM`.
  let low = 0;
  let high = tangent;
  for (let i = 0; i < 50; ++i) {
    const middle = (low + high) / 2;
    if (fitAxis(corners, middle).distanceM > distanceM) low = middle;
    else high = middle;
  }
  return fitAxis(corners, high).sidewaysM;
}

/** Returns the nearest position from which a camera that looks along -`backward` sees all eight corners within ±`tangents`, centred. */
export function frameBox(extent: ViewedBox, backward: Vector3, tangents: { across: number; up: number }): Placement {
  const back = backward.clone().normalize();
  const right = new Vector3(0, 1, 0).cross(back).normalize();
  const up = back.clone().cross(right);
  const halfX = extent.sideM / 2;
  const halfZ = (extent.widthM ?? extent.sideM) / 2;
  const middleM = new Vector3(extent.centreM?.x ?? 0, (extent.minYM + extent.maxYM) / 2, extent.centreM?.z ?? 0);
  const [c, s] = [Math.cos(extent.turnRad ?? 0), Math.sin(extent.turnRad ?? 0)];
  const across: AxisCorners = [];
  const upward: AxisCorners = [];
  for (const x of [-halfX, halfX])
    for (const y of [extent.minYM, extent.maxYM])
      for (const z of [-halfZ, halfZ]) {
        const corner = new Vector3(c * x - s * z, y - middleM.y, s * x + c * z);
        across.push([corner.dot(right), corner.dot(back)]);
        upward.push([corner.dot(up), corner.dot(back)]);
      }
  const distanceM = Math.max(fitAxis(across, tangents.across).distanceM, fitAxis(upward, tangents.up).distanceM);
  const targetM = middleM
    .addScaledVector(right, centreAxis(across, tangents.across, distanceM))
    .addScaledVector(up, centreAxis(upward, tangents.up, distanceM));
  return { positionM: targetM.clone().addScaledVector(back, distanceM), targetM };
}
