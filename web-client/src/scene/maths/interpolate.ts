// Bounds, ramps and values between others.

export function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}

/** Returns 0 below `from`, 1 above `to`, linear between. */
export function ramp(from: number, to: number, at: number): number {
  return clamp((at - from) / (to - from), 0, 1);
}

/** Returns an even start and end for a share 0..1. */
export function smooth(share: number): number {
  return share * share * (3 - 2 * share);
}

export function smoothstep(from: number, to: number, at: number): number {
  return smooth(ramp(from, to, at));
}

export function mix(a: number, b: number, share: number): number {
  return a + (b - a) * share;
}

/** Returns the same angle in -pi..pi. */
export function wrapAngle(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}

/** Interpolates between two angles by the shorter arc; the result is in -pi..pi. */
export function mixAngle(from: number, to: number, share: number): number {
  return wrapAngle(from + wrapAngle(to - from) * share);
}
