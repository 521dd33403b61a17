/** Returns a function that opens a card, which it loads first; `failed` is called when that does not work, and the next call tries again. */
export function lateCard(load: () => Promise<{ open(): void }>, failed: () => void): () => void {
  let card: ReturnType<typeof load> | undefined;
  return () => {
    card ??= load();
    card.then((one) => one.open(), () => {
      card = undefined;
      failed();
    });
  };
}
