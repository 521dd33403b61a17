// Lines for people about the connection and about requests: English. net_texts_de.ts has the German ones. The worker has a table of its own.
import { translation } from "./translation";

const kEnglish = {
  notConnected: "not connected to the server",
  tooManyWait: (count: number) => `${count} commands are waiting for an answer already; try again in a moment`,
  congested: "the link to the server is congested; try again in a moment",
  noAnswer: (forS: number) => `no answer for ${forS} s`,
  silent: (forS: number) => `no message from the server for ${forS} s`,
  closed: (code: number) => `closed by the server or the network (code ${code})`,
  pageCloses: "the page closed the connection",
  renamed: "the page connects again under another name",
  moves: "the page moves to another server",
  otherVersion: (server: string, page: string) => `the server speaks version ${server} of the wire, this page ${page}; reload the page`,
  restarts: "the server restarts",
  lost: "the connection was lost before the answer came",
  refused: "the server refused the connection",
  noRoom: (room: string) => `there is no room ${room}`,
  noRoomBecause: (room: string, why: string) => `there is no room ${room}: ${why}`,
  unreadableName: "its name cannot be read",
  notOperator: (why: string) => `${why}. Open the operator's link first, or choose one of these rooms`,
  serverSilent: "the server does not answer",
  answers: (status: number) => `the server answers ${status}`,
  notNumbers: (list: string) => `${list} is not a list of numbers`,
  unequalLists: (counts: string) => `lists of ${counts} numbers have to be of one length`,
  notAscending: (list: string) => `${list} has to ascend`,
  noGround: (room: string, status: string) => `the ground of ${room}: ${status}`,
  noJoin: (status: number) => `The server does not say how to join (${status}).`,
};

export type NetTexts = typeof kEnglish;

/** In the language that was loaded before. */
export const kNetTexts: NetTexts = { ...kEnglish, ...translation.net };
