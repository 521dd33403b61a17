// The parameters that an operator has changed, in the page's address: `room`, `scene` and `set` together say how the room is opened anew
// where it does not exist. A room that exists keeps its own values, so nobody's water changes by a link.
import { textOfValues } from "../net/room_address";
import { requestChanges } from "../../client/rest/rooms";
import { setAddressParameter } from "./address";
import type { App } from "./app";

/** A slider that is being moved changes its value many times per second. */
const kRestMs = 1000;

export function keepChangesInAddress(app: App): void {
  let timer = 0;
  const write = async (): Promise<void> => {
    const { entered } = app;
    if (!entered?.scenes.includes(entered.sceneName)) return;
    const values = await requestChanges(entered.room, app.token).catch(() => undefined);
    if (!values || app.entered !== entered) return;
    if (values.length > 0) {
      setAddressParameter("room", entered.room);
      setAddressParameter("scene", entered.sceneName);
    }
    setAddressParameter("set", textOfValues(values) || undefined);
  };
  app.parameterChanged = () => {
    if (app.role !== "operator") return;
    window.clearTimeout(timer);
    timer = window.setTimeout(() => void write(), kRestMs);
  };
}
