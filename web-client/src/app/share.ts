// The Share button and what its card needs of the page. The card is loaded when it is opened.
import { askJoinAddresses } from "../net/join_addresses";
import { openRoomWithTokens, requestChanges } from "../../client/rest/rooms";
import type { ParameterValue } from "../../client/rest/rooms";
import type { ShareSource } from "../ui/share_card";
import { kTexts } from "../ui/texts";
import type { App } from "./app";
import { lateCard } from "./late_card";

export function addShareButton(app: App): void {
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
  const open = lateCard(() => import("../ui/share_card").then(({ ShareCard }) => new ShareCard(source)), () => app.warn(kTexts.shareFailed));
  const button = app.actions.add("share", "share", kTexts.share, open);
  button.element.setAttribute("aria-haspopup", "dialog");
}

/** Returns a name that no room has, of at most 32 characters. */
function freshName(scene: string): string {
  return `${scene.slice(0, 23)}-${crypto.getRandomValues(new Uint32Array(1))[0]!.toString(16).padStart(8, "0")}`;
}
