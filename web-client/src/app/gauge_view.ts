// What the gauges need of the page; loaded with the first gauge.
import type { GreetingInfo } from "../codec/greeting";
import { GaugeView } from "../gauges/gauge_view";
import { requestSeries } from "../net/gauge_request";
import { byId } from "../ui/dom";
import { fileName, saveFile } from "./saved_file";

/** What of App this needs. */
interface Page {
  readonly entered: GreetingInfo | undefined;
  readonly token: string;
  warn(text: string): void;
}

export function makeGaugeView(page: Page): GaugeView {
  const sceneName = (): string => page.entered?.sceneName || page.entered?.room || "";
  return new GaugeView({
    title: () => page.entered?.title ?? "",
    requestSeries: (gauge) => requestSeries(page.entered?.room ?? "", gauge, page.token),
    save: (blob, extension) => saveFile(blob, fileName(`${sceneName()} gauges`, extension, new Date())),
    fail: (text) => page.warn(text),
    openSheet: () => document.body.classList.contains("panel-closed") && byId("panel-toggle").click(),
  });
}
