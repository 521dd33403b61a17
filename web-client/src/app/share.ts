// The Share button and what its card needs of the page. The card is loaded when it is opened.
import { askJoinAddresses } from "../net/join_addresses";
import { openRoomWithTokens, requestChanges } from "../net/room_requests";
import type { ParameterValue } from "../net/room_address";
import { make } from "../ui/dom";
import type { ShareSource } from "../ui/share_card";
import type { App } from "./app";

const kIcon = '<svg viewBox="0 0 24 24" aria-hidden="true"><circle cx="6" cy="12" r="2.6" /><circle cx="17.5" cy="5.5" r="2.6" /><circle cx="17.5" cy="18.5" r="2.6" /><path d="M8.3 10.7l6.9-3.9M8.3 13.3l6.9 3.9" /></svg>';

export function makeShareButton(app: App): HTMLButtonElement {
  const button = make("button", { id: "share-toggle", class: "glass", type: "button", "data-testid": "share", "aria-label": "Share", title: "A link to what you see, also as a QR code", "aria-haspopup": "dialog" });
  button.innerHTML = kIcon;
  const sceneNow = (): string | undefined => (app.entered?.scenes.includes(app.entered.sceneName) ? app.entered.sceneName : undefined);
  const changes = (): Promise<ParameterValue[]> => requestChanges(app.entered?.room ?? "", app.token);
  const source: ShareSource = {
    address: () => app.address,
    scene: sceneNow,
    mayOpen: () => app.role === "operator",
    joinAddresses: () => askJoinAddresses(app.token),
    changes,
    openForRoles: async () => openRoomWithTokens(freshName(sceneNow() ?? ""), { scene: sceneNow() ?? "", parameters: await changes() }, app.token),
  };
  const load = (): Promise<{ open(): void }> => import("../ui/share_card").then(({ ShareCard }) => new ShareCard(source));
  let card: ReturnType<typeof load> | undefined;
  button.addEventListener("click", () => {
    card ??= load();
    card.then((one) => one.open(), () => {
      card = undefined;
      app.warn("The card could not be loaded: try again when the server can be reached.");
    });
  });
  return button;
}

/** Returns a name that no room has, of at most 32 characters. */
function freshName(scene: string): string {
  return `${scene.slice(0, 23)}-${crypto.getRandomValues(new Uint32Array(1))[0]!.toString(16).padStart(8, "0")}`;
}
