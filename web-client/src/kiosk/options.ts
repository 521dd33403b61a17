// The options of a kiosk in the page's address: `?kiosk`, or `?kiosk=SECONDS` until the countdown. Pure.

const kIdleS = { min: 10, max: 3600, default: 60 };

/** Returns the time without input until the countdown, and what is wrong with the address, for people; undefined if nothing is. */
export function kioskOptions(search: string): { idleS: number; problem: string | undefined } {
  const text = new URLSearchParams(search).get("kiosk") ?? "";
  if (text === "") return { idleS: kIdleS.default, problem: undefined };
  const idleS = Number(text);
  if (/^\d+(\.\d+)?$/.test(text) && idleS >= kIdleS.min && idleS <= kIdleS.max) return { idleS, problem: undefined };
  return { idleS: kIdleS.default, problem: `kiosk=${text.slice(0, 20)} in the address: expected seconds from ${kIdleS.min} to ${kIdleS.max}; ${kIdleS.default} are used` };
}
