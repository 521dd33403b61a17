// Names for people who have not said theirs. Pure.

const kKinds = ["Merry", "Brave", "Swift", "Sunny", "Clever", "Lucky", "Bold", "Gentle", "Nimble", "Jolly", "Calm", "Bright"] as const;
const kAnimals = ["Otter", "Seal", "Gull", "Puffin", "Dolphin", "Heron", "Crab", "Turtle", "Osprey", "Penguin", "Walrus", "Marlin", "Tern", "Squid", "Orca", "Pelican"] as const;

/** `random`: in [0, 1). */
export function friendlyName(random: () => number): string {
  const of = (names: readonly string[]): string => names[Math.floor(random() * names.length)]!;
  return `${of(kKinds)} ${of(kAnimals)}`;
}
