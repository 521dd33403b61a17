// What main.ts has loaded before the tables of texts are read: nothing for English. Tables that only later chunks read are theirs alone.

/** Each takes the place of the English table of this name. */
type Tables = Record<"page" | "net" | "gauge" | "front" | "kiosk" | "class" | "pad" | "share" | "keys", object>;

export const translation: Partial<Tables> & {
  /** BCP 47, for numbers. */
  locale: string;
} = { locale: "en" };
