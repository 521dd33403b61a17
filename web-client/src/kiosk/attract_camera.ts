// The camera while nobody touches a kiosk: it swings slowly round what the first view shows, and breathes a little nearer and higher. Pure.
type Place = [x: number, y: number, z: number];

/** Swing to each side [rad], and how long there and back takes. */
const kSwingRad = 0.42;
const kSwingS = 64;
/** Share by which it comes nearer, and how long that takes. */
const kNearer = 0.12;
const kNearerS = 41;

/** Returns the position of the camera after so long; it begins at rest in the first view. */
export function attractEye([eyeX, eyeY, eyeZ]: Place, [targetX, targetY, targetZ]: Place, forS: number): Place {
  // The square begins without speed.
  const begin = Math.min(forS / 8, 1) ** 2;
  const angleRad = begin * kSwingRad * Math.sin((2 * Math.PI * forS) / kSwingS);
  const nearer = 1 - (kNearer / 2) * (1 - Math.cos((2 * Math.PI * forS) / kNearerS));
  const [c, s] = [Math.cos(angleRad), Math.sin(angleRad)];
  const [x, y, z] = [(eyeX - targetX) * nearer, (eyeY - targetY) * nearer, (eyeZ - targetZ) * nearer];
  return [targetX + x * c - z * s, targetY + y, targetZ + x * s + z * c];
}
