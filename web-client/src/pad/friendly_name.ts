// Names for people who have not said theirs. Pure.
import { kPadTexts } from "../ui/pad_texts";

/** `random`: in [0, 1). */
export function friendlyName(random: () => number): string {
  const of = (names: readonly string[]): string => names[Math.floor(random() * names.length)]!;
  return `${of(kPadTexts.nameKinds)} ${of(kPadTexts.nameAnimals)}`;
}
