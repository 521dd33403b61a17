// Drops, foam and bubbles of the time shown: lets them begin (sources.ts), moves them (diffuse_particles.ts) and uploads them.
// Reads the frames and the boats as drawn. Writes the white water: points for the passes of white_points.ts.
import type { GreetingInfo } from "../../../client/codec/greeting";
import type { Pass, Picture } from "../drawing/pass";
import type { WhitewaterQuality } from "../drawing/quality";
import { kBoatsMax } from "../frames/bodies";
import type { StreamedFrames } from "../frames/streamed_frames";
import { makeFastRandom } from "../maths/random";
import type { SolidsPass } from "../solids/solids_pass";
import { DiffuseParticles, kFloatsPerParticle, kHullPoint, kMaxStepS, type Medium } from "./diffuse_particles";
import { MovingSurface, restingSurface, type Surface } from "./moving_surface";
import { addCrests, addHulls, addRims, rimOf, sizeRatioOf, type Births, type RimPoint } from "./sources";
import { WhitePoints } from "./white_points";

/** After a longer gap, or when time goes back, the white water starts anew. Of shorter ones the last kLongestS are computed. */
const kGapS = 4;
const kLongestS = 0.5;
const kSeed = 20_260_101;

export class WhitewaterPass implements Pass {
  readonly name = "whitewater";
  readonly reads = ["frames", "solids"] as const;
  readonly writes = ["whitewater"] as const;
  readonly points: WhitePoints;
  readonly particles: DiffuseParticles;
  private readonly births: Births;
  private readonly rim: readonly RimPoint[];
  private lastS: number | undefined;

  /** `greeting` is read in every picture, because its boats and its wind change. */
  constructor(
    private readonly greeting: GreetingInfo,
    private readonly frames: StreamedFrames,
    private readonly solids: SolidsPass,
    quality: WhitewaterQuality,
  ) {
    const random = makeFastRandom(kSeed);
    this.particles = new DiffuseParticles(quality.capacityCount, random);
    this.births = { particles: this.particles, random, scale: quality.densityRatio, sizeRatio: sizeRatioOf(Math.min(greeting.sideM, greeting.widthM)) };
    this.points = new WhitePoints(this.particles.values);
    this.rim = rimOf(greeting.obstacles);
  }

  draw({ shownS }: Picture): void {
    this.follow(shownS);
    this.points.upload(this.particles.count + this.placeHulls());
  }

  remember({ shownS }: Picture): void {
    this.solids.place(shownS);
    this.follow(shownS);
  }

  /** Brings the white water to a time. */
  private follow(shownS: number | undefined): void {
    const { wave, sideM, widthM } = this.greeting;
    const surfaces = shownS === undefined ? undefined : this.frames.surfaces.around(shownS);
    if (shownS === undefined || (wave && !surfaces)) return;
    const stepS = shownS - (this.lastS ?? shownS);
    this.lastS = shownS;
    if (stepS < 0 || stepS > kGapS) this.particles.clear();
    else if (stepS > 0) this.advance(Math.min(stepS, kLongestS), surfaces ? new MovingSurface(surfaces) : restingSurface(sideM, widthM));
  }

  /** Writes the boats behind the particles, for the foam and the shade around their hulls (whitewater.vert). Returns how many. */
  private placeHulls(): number {
    const { greeting, particles, solids } = this;
    const poses = solids.drawnBoats().slice(0, kBoatsMax);
    poses.forEach(({ boatId, xM, zM, headingRad, speedMps }, n) => {
      const { lengthM = 0, beamM = 0 } = greeting.boats.find((boat) => boat.boatId === boatId) ?? {};
      const hull = [xM, speedMps, zM, kHullPoint, Math.cos(headingRad), beamM, Math.sin(headingRad), lengthM];
      particles.values.set(hull, (particles.count + n) * kFloatsPerParticle);
    });
    return poses.length;
  }

  dispose(): void {
    this.points.dispose();
  }

  private advance(stepS: number, surface: Surface): void {
    const { births, greeting } = this;
    const gravityMps2 = greeting.wind?.gravityMps2 ?? 9.81;
    addCrests(births, surface, stepS);
    const hulls = new Map(greeting.boats.map((boat) => [boat.boatId, boat]));
    addHulls(births, this.solids.drawnBoats(), hulls, surface, gravityMps2, stepS);
    addRims(births, this.rim, surface, stepS);
    const medium = this.medium(surface, gravityMps2);
    for (let leftS = stepS; leftS > 1e-6; leftS -= kMaxStepS) this.particles.step(Math.min(leftS, kMaxStepS), medium);
  }

  private medium(surface: Surface, gravityMps2: number): Medium {
    const { levelRatio = 0, speedMps = 0, directionDeg = 0 } = this.greeting.wind ?? {};
    const angle = (directionDeg * Math.PI) / 180;
    const blowsMps = levelRatio * speedMps;
    return {
      elevationAtM: (xM, zM) => surface.elevationAtM(xM, zM),
      gravityMps2,
      windMps: { x: blowsMps * Math.cos(angle), z: blowsMps * Math.sin(angle) },
    };
  }
}
