// The gamepad in use.

/** Returns the first gamepad of the standard mapping; undefined without one, and where the browser or the embedding page allows none. */
export function standardGamepad(): Gamepad | undefined {
  try {
    return navigator.getGamepads?.().find((each) => each?.mapping === "standard") ?? undefined;
  } catch {
    return undefined;
  }
}
