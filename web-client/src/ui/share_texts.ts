// Texts of the card of "Share": English. texts_de.ts has the German ones.
import type { RoleName } from "../../client/codec/people";
import { translation } from "../net/translation";
import type { Row } from "./texts";

const kEnglish = {
  title: "Share this view", qr: "QR code of the link", link: "Link", copy: "Copy", send: "Send …", close: "Close", openRoom: "Open the room",
  target: { label: "Leads to", help: "Where the link leads." } as Row,
  targets: { room: "this room, with everybody in it", copy: "a room of its own like this one", roles: "a new room, by roles", embed: "a page of yours, as code" },
  notes: {
    room: "",
    copy: "Everybody with this link comes into one room, apart from this one. An operator has to open it first.",
    roles: "Whoever has the link has the role, until the room ends. The links are shown until this page is closed.",
    embed: "The server shows its water only in pages that it lists: start it with --embed and the origin of your page, such as https://school.example.",
  },
  role: { label: "For", help: "The role of those who open the link." } as Row,
  roles: { operator: "the presenter", player: "players", viewer: "watchers", kiosk: "a kiosk" } as Record<RoleName | "kiosk", string>,
  kioskNote: "Open it on the screen that visitors use: they are players, and nothing leads out of the page.",
  onlyHere: "Only this computer can open this link: start the server with --address 0.0.0.0 for phones and other computers.",
  opening: "Opening the room: this takes some seconds.",
  notOpened: (why: string) => `The room could not be opened: ${why}`,
  tooLong: "The link is too long for a QR code.",
  copied: "It is copied.",
  notCopied: "The browser does not allow to copy: select the text and copy it by hand.",
  notSent: "The browser cannot send the link: copy it.",
};

export type ShareTexts = typeof kEnglish;

/** In the language that was loaded before. */
export const kShareTexts: ShareTexts = { ...kEnglish, ...translation.share };
