// A small live picture of a room: its water from above, as the pad draws it. It asks for coarse frames at a low rate, and as an onlooker:
// whoever sees the picture is not in the room.
import type { RoleName } from "../../client/codec/people";
import type { GreetingInfo } from "../../client/codec/greeting";
import type { PageEventHandlers } from "../net/messages";
import { openWaterClient, socketUrl } from "../net/water_client";
import { LessonState } from "../ui/lesson_state";
import { kMarginPx } from "../pad/map_view";
import { PadMap } from "../pad/pad_map";
import { pictureWidthPercent } from "./front_model";

const kFrameRateHz = 4;

export class LivePicture {
  private readonly client = openWaterClient(this.handlers());
  private readonly lessons = new LessonState();
  private readonly map: PadMap;
  private greeting: GreetingInfo | undefined;
  private isClosed = false;

  /** `page`: the address of the room's page. `welcomed` gets the role that the room gives to this visitor. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    page: string,
    private readonly token: string,
    private readonly welcomed: (role: RoleName) => void,
  ) {
    this.map = new PadMap(canvas);
    this.client.start(`${socketUrl(page)}?onlooker`, { name: "", token, resumeKey: "" });
    this.client.want({ layers: ["surface", "bodies", "floaters"], detail: "coarse", frameRateHz: kFrameRateHz });
  }

  /** Newest time of the simulation; 0 before the first frame. */
  get simTimeS(): number {
    return this.map.simTimeS;
  }

  draw(nowS: number): void {
    if (!this.greeting || this.map.counts().surfaceCells === 0) return;
    this.canvas.hidden = false;
    this.map.draw(nowS, this.lessons, { followedId: 0, ownBoatId: 0, fingers: [], ownFingers: [], previews: [] });
  }

  /** Ends the connection; the last picture stays. */
  close(): void {
    this.isClosed = true;
    this.client.close();
  }

  private handlers(): PageEventHandlers {
    const nothing = (): void => {};
    return {
      state: nothing,
      greeting: ({ greeting }) => this.enter(greeting),
      welcome: ({ welcome }) => this.welcomed(welcome.role),
      frame: ({ frame }) => {
        if (!this.map.take(frame)) this.client.release(frame);
      },
      people: ({ people }) => this.lessons.set({ people }),
      game: ({ game }) => this.lessons.set({ game }),
      boatList: ({ boats }) => {
        if (this.greeting) this.greeting.boats = boats;
      },
      clock: ({ leadS }) => this.map.sync(leadS + performance.timeOrigin / 1000),
      lesson: nothing,
      strokes: nothing,
      ack: nothing,
      reject: nothing,
      draining: nothing,
      roomEvent: nothing,
      roomState: nothing,
      parameterChanged: nothing,
      diagnostics: nothing,
      stats: nothing,
    };
  }

  private enter(greeting: GreetingInfo): void {
    this.greeting = greeting;
    const aspectRatio = greeting.sideM / greeting.widthM;
    this.canvas.style.aspectRatio = String(aspectRatio);
    this.canvas.style.width = `calc(${pictureWidthPercent(aspectRatio)}% + ${2 * kMarginPx}px)`;
    this.map.enter(greeting, (frame) => this.client.release(frame));
    if (!greeting.hasBed) return;
    this.client.requestGround(greeting.room, this.token).then(
      (ground) => !this.isClosed && this.greeting === greeting && this.map.setGround(ground),
      (error: unknown) => console.warn(`spindrift: the picture of ${greeting.room} is drawn without land: ${error instanceof Error ? error.message : String(error)}`),
    );
  }
}
