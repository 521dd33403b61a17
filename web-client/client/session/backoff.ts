// Wait before the next attempt to connect: doubles from 0.5 s to 8 s, with a random spread of ±25 % so that the clients of a
// restarted server do not all return at once.

const kBackoffMinS = 0.5;
const kBackoffMaxS = 8;

/** `attemptCount`: attempts that failed so far; `random` in [0, 1). */
export function backoffS(attemptCount: number, random: number): number {
  const wanted = kBackoffMinS * 2 ** Math.min(Math.max(attemptCount - 1, 0), 16);
  const spread = Math.min(wanted, kBackoffMaxS) * (0.75 + 0.5 * random);
  return Math.min(Math.max(spread, kBackoffMinS), kBackoffMaxS);
}
