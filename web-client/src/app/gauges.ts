// The gauges of the room. Their poles are part of the scene; names, panel and chart are loaded with the first gauge.
import { Matrix4 } from "three";

import type { GreetingInfo } from "../codec/greeting";
import type { DiagnosticsInfo } from "../codec/parse";
import type { GaugeView } from "../gauges/gauge_view";
import { tagPlace } from "../ui/tag_place";
import type { Display } from "./display";

export class Gauges {
  private view: GaugeView | undefined;
  private isLoading = false;
  private water = "";
  private readonly seen = new Matrix4();

  /** `load`: loads the view; undefined if it cannot, which has been said then. */
  constructor(
    private readonly display: Display,
    private readonly load: () => Promise<GaugeView | undefined>,
  ) {}

  enter({ room, sceneName, gauges }: GreetingInfo): void {
    const water = `${room} ${sceneName}`;
    this.display.scene.setGauges(gauges);
    this.view?.setGauges(gauges, water !== this.water);
    this.water = water;
    if (gauges.length > 0 && !this.isLoading) void this.open();
  }

  take({ gaugesTimeS, gauges }: DiagnosticsInfo): void {
    if (gaugesTimeS > 0) this.view?.take(gaugesTimeS, gauges);
  }

  /** Called for each picture. */
  update(): void {
    const { view, seen } = this;
    if (!view) return;
    const { scene, covered } = this.display;
    seen.multiplyMatrices(scene.camera.projectionMatrix, scene.camera.matrixWorldInverse);
    for (const { name, xM, topM, zM } of scene.drawnGauges()) view.tags.show(name, tagPlace(seen, [xM, topM, zM], window.innerWidth, window.innerHeight, covered));
  }

  private async open(): Promise<void> {
    this.isLoading = true;
    this.view = await this.load();
    this.view?.setGauges(this.display.scene.drawnGauges(), true);
    // The next greeting tries again.
    this.isLoading = this.view !== undefined;
  }
}
