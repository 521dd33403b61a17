// Lines for people about the connection and about requests. A program may put others in their place: Object.assign(kSessionTexts, ...).

export const kSessionTexts = {
  notConnected: "not connected to the server",
  tooManyWait: (count: number) => `${count} commands are waiting for an answer already; try again in a moment`,
  congested: "the link to the server is congested; try again in a moment",
  noAnswer: (forS: number) => `no answer for ${forS} s`,
  silent: (forS: number) => `no message from the server for ${forS} s`,
  closed: (code: number) => `closed by the server or the network (code ${code})`,
  closedHere: "the connection was closed here",
  renamed: "connecting again under another name",
  moves: "moving to another server",
  otherVersion: (server: string, client: string) => `the server speaks version ${server} of the wire, this client ${client}; reload the page, or update the client`,
  restarts: "the server restarts",
  lost: "the connection was lost before the answer came",
  refused: "the server refused the connection",
  noRoom: (room: string) => `there is no room ${room}`,
  noRoomBecause: (room: string, why: string) => `there is no room ${room}: ${why}`,
  serverSilent: "the server does not answer",
  answers: (status: number) => `the server answers ${status}`,
  notNumbers: (list: string) => `${list} is not a list of numbers`,
  unequalLists: (counts: string) => `lists of ${counts} numbers have to be of one length`,
  notAscending: (list: string) => `${list} has to ascend`,
  noGround: (room: string, status: string) => `the ground of ${room}: ${status}`,
};

export type SessionTexts = typeof kSessionTexts;
