// The camera's buttons: which view is shown, and whether there is a boat to follow.
import type { CameraViews, ViewName } from "../scene/camera/camera_views";
import { byId } from "./dom";

const kViewNames: readonly ViewName[] = ["start", "side", "overview", "below", "boat"];

export class ViewButtons {
  private readonly boat = byId<HTMLButtonElement>("view-boat");
  private readonly below = byId<HTMLButtonElement>("view-below");

  constructor(
    private readonly views: CameraViews,
    private readonly nowS: () => number,
    /** Id of the boat to follow; 0 for none. */
    private readonly myBoatId: () => number,
  ) {
    for (const name of kViewNames) byId(`view-${name}`).addEventListener("click", () => this.show(name));
    views.left = () => this.refresh();
  }

  set hasBoats(hasBoats: boolean) {
    this.boat.hidden = !hasBoats;
  }

  set canDive(canDive: boolean) {
    this.below.hidden = !canDive;
  }

  /** Leaves the boat's view when there is no boat to follow. */
  boatChanged(): void {
    if (this.myBoatId() === 0 && this.views.view === "boat") this.show("overview");
    this.refresh();
  }

  refresh(): void {
    for (const name of kViewNames) byId(`view-${name}`).setAttribute("aria-pressed", String(this.views.view === name));
    this.boat.disabled = this.myBoatId() === 0;
    document.body.classList.toggle("boat-view", this.views.view === "boat");
  }

  /** Shows the next view that there is. */
  step(): void {
    const names = kViewNames.filter((name) => !byId(`view-${name}`).hidden && !(name === "boat" && this.boat.disabled));
    const at = this.views.view === undefined ? -1 : names.indexOf(this.views.view);
    byId(`view-${names[(at + 1) % names.length]!}`).click();
  }

  private show(name: ViewName): void {
    this.views.go(name, this.nowS());
    this.refresh();
  }
}
