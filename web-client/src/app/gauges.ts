// The gauges of the room: those of its scene, and those that people have placed. Their poles are part of the picture; names, panel and chart
// are loaded where there is water to measure.
import { Matrix4 } from "three";

import type { GreetingInfo } from "../../client/codec/greeting";
import type { DiagnosticsInfo } from "../../client/codec/parse";
import type { GaugeInfo } from "../../client/codec/scene_info";
import type { GaugeView } from "../gauges/gauge_view";
import { tagPlace } from "../ui/tag_place";
import type { Display } from "./display";

export class Gauges {
  private view: GaugeView | undefined;
  private isLoading = false;
  private water = "";
  private ofScene: readonly GaugeInfo[] = [];
  private placed: readonly GaugeInfo[] = [];
  private readonly seen = new Matrix4();

  /** `load`: loads the view; undefined if it cannot, which has been said then. */
  constructor(
    private readonly display: Display,
    private readonly load: () => Promise<GaugeView | undefined>,
  ) {}

  enter({ room, sceneName, gauges, wave }: GreetingInfo): void {
    const water = `${room} ${sceneName}`;
    const isOtherWater = water !== this.water;
    this.water = water;
    this.ofScene = gauges;
    if (isOtherWater) this.placed = [];
    this.show(isOtherWater);
    if (wave && !this.isLoading) void this.open();
  }

  take({ gaugesTimeS, gauges }: DiagnosticsInfo): void {
    const placed = gauges.flatMap(({ name, xM, zM, gaugeId, personId }) => (gaugeId === 0 ? [] : [{ name, xM, zM, placed: { gaugeId, personId } }]));
    if (JSON.stringify(placed) !== JSON.stringify(this.placed)) {
      this.placed = placed;
      this.show(false);
    }
    if (gaugesTimeS > 0) this.view?.take(gaugesTimeS, gauges.filter(({ unread }) => !unread));
  }

  /** Called for each picture. */
  update(): void {
    const { view, seen } = this;
    if (!view) return;
    const { scene, covered } = this.display;
    seen.multiplyMatrices(scene.camera.projectionMatrix, scene.camera.matrixWorldInverse);
    for (const { name, xM, topM, zM } of scene.drawnGauges()) view.tags.show(name, tagPlace(seen, [xM, topM, zM], window.innerWidth, window.innerHeight, covered));
  }

  private show(isOtherWater: boolean): void {
    const all = [...this.ofScene, ...this.placed];
    this.display.scene.setGauges(all);
    this.view?.setGauges(all, isOtherWater);
  }

  private async open(): Promise<void> {
    this.isLoading = true;
    this.view = await this.load();
    this.view?.setGauges([...this.ofScene, ...this.placed], true);
    // The next greeting tries again.
    this.isLoading = this.view !== undefined;
  }
}
