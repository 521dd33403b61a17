// People, of as many triangles as their size on the screen deserves.
import type { MeshBuilder, Paint, Point } from "./mesh_builder";
import { addRod, addTurned } from "./shapes";

const kLifeJacket: Paint = [0.72, 0.20, 0.02, 0.6];
const kTrousers: Paint = [0.05, 0.06, 0.09, 0.8];
const kSkin: Paint = [0.48, 0.29, 0.20, 0.6];
const kCap: Paint = [0.06, 0.07, 0.11, 0.6];

/** Adds somebody, in a life jacket unless another is given: standing on a point, or seated on it with the legs out of sight. */
export function addPerson(builder: MeshBuilder, [x, y, z]: Point, tallM: number, isSeated: boolean, isFine: boolean, jacket = kLifeJacket): void {
  const seatedM = isSeated ? 0.45 * tallM : 0;
  const turn = (up: number, radius: number, paint: Paint): { yM: number; radiusM: number; paint: Paint } => ({ yM: up * tallM - seatedM, radiusM: radius * tallM, paint });
  const legs = isSeated ? [] : [turn(0, 0.09, kTrousers)];
  const [body, head] = [[turn(0.47, 0.12, jacket), turn(0.62, 0.145, jacket), turn(0.78, 0.135, jacket)], [turn(0.83, 0.05, kSkin), turn(0.86, 0.075, kSkin), turn(0.93, 0.085, kCap), turn(1.01, 0, kCap)]];
  addTurned(builder, [x, y, z], [...legs, ...(isFine ? body.concat(head) : [body[0]!, turn(0.8, 0.11, kSkin), head[3]!])], isFine ? 7 : 3);
  for (const side of isFine ? [-1, 1] : []) {
    const at = (out: number, up: number, ahead: number): Point => [x + ahead * tallM, y + up * tallM - seatedM, z + side * out * tallM];
    addRod(builder, at(0.15, 0.77, 0), at(0.1, 0.6, 0.19), 0.035 * tallM, jacket, 5);
  }
}
