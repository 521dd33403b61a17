// Names over the gauges in the picture. Hidden from screen readers, as the boats' names are: the panel lists them.
import type { GaugeInfo } from "../../client/codec/scene_info";
import { make } from "../ui/dom";
import type { TagPlace } from "../ui/tag_place";

export class GaugeTags {
  private readonly element = make("div", { class: "gauge-tags", "aria-hidden": "true", "data-testid": "gauge-tags" });
  private readonly labels = new Map<string, HTMLElement>();

  /** `before`: the tags lie over this element and under everything after it. */
  constructor(before: Element) {
    before.after(this.element);
  }

  setGauges(gauges: readonly GaugeInfo[]): void {
    this.labels.clear();
    for (const { name } of gauges) {
      const tag = make("span", { hidden: "" }, [name]);
      this.labels.set(name, tag);
    }
    this.element.replaceChildren(...this.labels.values());
  }

  /** Called for each picture and gauge. `place`: of its top; undefined where it is not seen. */
  show(name: string, place: TagPlace | undefined): void {
    const tag = this.labels.get(name);
    if (!tag) return;
    tag.hidden = place === undefined;
    if (place) tag.style.transform = `translate(${place.xPx.toFixed(1)}px, ${place.yPx.toFixed(1)}px) translate(-50%, -100%)`;
  }
}
