// Lines for people about the connection and about requests: those of the client and the page's own. English; net_texts_de.ts has the German
// ones. The worker has a table of its own.
import { kSessionTexts, type SessionTexts } from "../../client/session/texts";
import { translation } from "./translation";

const kOfThePage = {
  unreadableName: "its name cannot be read",
  notOperator: (why: string) => `${why}. Open the operator's link first, or choose one of these rooms`,
  noJoin: (status: number) => `The server does not say how to join (${status}).`,
};

export type NetTexts = SessionTexts & typeof kOfThePage;

/** The client's own table, in the language that was loaded before. */
export const kNetTexts: NetTexts = Object.assign(kSessionTexts, kOfThePage, translation.net);
