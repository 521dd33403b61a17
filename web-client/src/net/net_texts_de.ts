// Lines about the connection and about requests in German.
import type { NetTexts } from "./net_texts";

export const kGermanNetTexts: NetTexts = {
  notConnected: "keine Verbindung zum Server",
  tooManyWait: (count) => `${count} Befehle warten schon auf eine Antwort; bitte gleich noch einmal versuchen`,
  congested: "die Leitung zum Server ist überlastet; bitte gleich noch einmal versuchen",
  noAnswer: (forS) => `keine Antwort seit ${forS} s`,
  silent: (forS) => `keine Nachricht vom Server seit ${forS} s`,
  closed: (code) => `vom Server oder vom Netz geschlossen (Code ${code})`,
  closedHere: "die Seite hat die Verbindung geschlossen",
  renamed: "die Seite verbindet sich unter einem anderen Namen",
  moves: "die Seite wechselt zu einem anderen Server",
  otherVersion: (server, page) => `der Server spricht Version ${server} des Protokolls, diese Seite ${page}; bitte neu laden`,
  restarts: "der Server startet neu",
  lost: "die Verbindung brach ab, bevor die Antwort kam",
  refused: "der Server hat die Verbindung abgelehnt",
  noRoom: (room) => `es gibt keinen Raum ${room}`,
  noRoomBecause: (room, why) => `es gibt keinen Raum ${room}: ${why}`,
  unreadableName: "sein Name ist nicht lesbar",
  notOperator: (why) => `${why}. Zuerst den Link der Leitung öffnen oder einen dieser Räume wählen`,
  serverSilent: "der Server antwortet nicht",
  answers: (status) => `der Server antwortet mit ${status}`,
  notNumbers: (list) => `${list} ist keine Liste von Zahlen`,
  unequalLists: (counts) => `die Listen haben ${counts} Zahlen und nicht gleich viele`,
  notAscending: (list) => `${list} muss ansteigen`,
  noGround: (room, status) => `der Grund von ${room}: ${status}`,
  noJoin: (status) => `Der Server sagt nicht, wie man mitmacht (${status}).`,
};
