// Names for people who have not said theirs. Pure.
import { kTexts } from "../ui/texts";

/** `random`: in [0, 1). */
export function friendlyName(random: () => number): string {
  const of = (names: readonly string[]): string => names[Math.floor(random() * names.length)]!;
  return `${of(kTexts.pad.nameKinds)} ${of(kTexts.pad.nameAnimals)}`;
}
