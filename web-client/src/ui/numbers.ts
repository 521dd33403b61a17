// Numbers as people write them in the page's language.
import { translation } from "../net/translation";

const formats = new Map<string, Intl.NumberFormat>();

function format(options: Intl.NumberFormatOptions): Intl.NumberFormat {
  const key = JSON.stringify(options);
  const known = formats.get(key) ?? new Intl.NumberFormat(translation.locale, options);
  formats.set(key, known);
  return known;
}

/** With so many decimals, as toFixed(); without marks between thousands. */
export function fixed(value: number, decimals: number): string {
  return format({ minimumFractionDigits: decimals, maximumFractionDigits: decimals, useGrouping: false }).format(value);
}

/** With as many decimals as it needs, at most three; without marks between thousands. */
export function plain(value: number): string {
  return format({ useGrouping: false }).format(value);
}

/** With marks between thousands. */
export function grouped(value: number): string {
  return format({}).format(value);
}

/** A length in words for people, to one or two digits: "8 mm", "35 cm", "1.2 m". */
export function length(lengthM: number): string {
  const [value, unit] = lengthM < 0.01 ? [1000 * lengthM, "mm"] : lengthM < 1 ? [100 * lengthM, "cm"] : [lengthM, "m"];
  return `${plain(Number(value.toPrecision(value < 10 && unit !== "m" ? 1 : 2)))} ${unit}`;
}
