// What the gauges need of the page; loaded where there is water to measure.
import type { GreetingInfo } from "../../client/codec/greeting";
import type { RoleName } from "../../client/codec/people";
import { GaugeView } from "../gauges/gauge_view";
import { requestSeries } from "../../client/rest/gauge_series";
import { byId } from "../ui/dom";
import { kGaugeTexts } from "../ui/gauge_texts";
import type { LessonState } from "../ui/lesson_state";
import { kTexts } from "../ui/texts";
import type { ToolBar } from "../ui/tool_bar";
import type { WaterPlace } from "../ui/tools";
import type { CommandSender } from "./command_sender";
import { fileName, saveFile } from "./saved_file";

/** What of App this needs. */
interface Page {
  readonly entered: GreetingInfo | undefined;
  readonly token: string;
  readonly role: RoleName;
  readonly lessons: LessonState;
  readonly commands: CommandSender;
  readonly tools: ToolBar;
  readonly display: { canvas: HTMLCanvasElement };
  placing: ((place: WaterPlace) => void) | undefined;
  warn(text: string): void;
}

export function makeGaugeView(page: Page): GaugeView {
  const sceneName = (): string => page.entered?.sceneName || page.entered?.room || "";
  const placing = new PlacingTap(page);
  const view: GaugeView = new GaugeView({
    title: () => page.entered?.title ?? "",
    requestSeries: (gauge) => requestSeries(page.entered?.room ?? "", gauge, page.token),
    save: (blob, extension) => saveFile(blob, fileName(`${sceneName()} gauges`, extension, new Date())),
    fail: (text) => page.warn(text),
    openSheet: () => document.body.classList.contains("panel-closed") && byId("panel-toggle").click(),
    isPlacing: () => placing.isOn,
    mayPlace: () => page.role !== "viewer" && page.entered?.wave !== undefined,
    mayRemove: (personId) => page.role !== "viewer" && (page.role === "operator" || personId === page.lessons.ownId),
    isOwn: (personId) => personId === page.lessons.ownId,
    nameOf: (personId) => page.lessons.personOf(personId)?.name,
    place: () => placing.toggle(),
    remove: (gaugeId) => page.commands.send({ case: "removeGauge", value: { gaugeId } }, kTexts.commands.removeGauge),
  });
  placing.changed = () => view.refresh();
  page.lessons.watch(() => view.refresh());
  return view;
}

/** While it is on, the next tap on the water places a gauge there. */
class PlacingTap {
  changed: () => void = () => {};
  /** In which it began. */
  private water: GreetingInfo | undefined;

  constructor(private readonly page: Page) {
    window.addEventListener("keydown", (event) => this.pressed(event), { capture: true });
    // Another tool is chosen, which says what it does.
    byId("tools").addEventListener("click", () => this.end(), { capture: true });
    page.lessons.watch(() => (page.entered !== this.water || page.role === "viewer" || page.lessons.whyNot(undefined) !== undefined) && this.end());
  }

  get isOn(): boolean {
    return this.page.placing !== undefined;
  }

  toggle(): void {
    const { page } = this;
    if (this.isOn) return this.end();
    const reason = page.lessons.whyNot(undefined);
    if (reason !== undefined) return page.warn(reason);
    this.water = page.entered;
    page.placing = (place) => this.place(place);
    page.tools.announce(window.matchMedia("(pointer: coarse)").matches ? kGaugeTexts.placeByTouch : kGaugeTexts.placeByMouse);
    page.display.canvas.focus({ preventScroll: true });
    this.changed();
  }

  private place({ xM, zM }: WaterPlace): void {
    this.page.commands.send({ case: "placeGauge", value: { xM, zM } }, kTexts.commands.gauge);
    this.end();
  }

  private end(): void {
    if (!this.isOn) return;
    this.page.placing = undefined;
    this.page.tools.announce(undefined);
    this.changed();
  }

  private pressed(event: KeyboardEvent): void {
    const key = event.key.toLowerCase();
    if (!this.isOn || !/^(escape|[1-9])$/.test(key)) return;
    // A digit chooses a tool.
    if (key === "escape") event.stopPropagation();
    this.end();
  }
}
