// Choices that the browser keeps for later visits. Where it keeps none (private windows, blocked storage), they last as long as the page.

export function keptChoice(key: string): string | undefined {
  try {
    return localStorage.getItem(`spindrift.${key}`) ?? undefined;
  } catch {
    return undefined;
  }
}

export function keepChoice(key: string, value: string): void {
  try {
    localStorage.setItem(`spindrift.${key}`, value);
  } catch {
    // Full or forbidden: the next visit has the default.
  }
}
