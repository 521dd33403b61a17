// What main.ts has loaded before the tables of texts are read: nothing for English.

export const translation: {
  /** BCP 47, for numbers. */
  locale: string;
  /** Each takes the place of the English table. */
  page?: object;
  net?: object;
} = { locale: "en" };
