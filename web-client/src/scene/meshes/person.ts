// People, of as many triangles as their size on the screen deserves.
import type { MeshBuilder, Paint, Point } from "./mesh_builder";
import { addRod, addTurned } from "./shapes";

const kLifeJacket: Paint = [0.72, 0.20, 0.02, 0.6];
const kTrousers: Paint = [0.05, 0.06, 0.09, 0.8];
const kSkin: Paint = [0.48, 0.29, 0.20, 0.6];
const kCap: Paint = [0.06, 0.07, 0.11, 0.6];
const kSidesCount = 7, kPlainSidesCount = 3;

/**
 * Adds somebody in a life jacket, unless another is given: standing on a point, or seated on it with the legs out of sight. `isFine`: with
 * arms, and more triangles.
 */
export function addPerson(builder: MeshBuilder, [x, y, z]: Point, tallM: number, isSeated: boolean, isFine: boolean, jacket = kLifeJacket): void {
  const seatedM = isSeated ? 0.45 * tallM : 0;
  const turn = (up: number, radius: number, paint: Paint): { yM: number; radiusM: number; paint: Paint } => ({ yM: up * tallM - seatedM, radiusM: radius * tallM, paint });
  const legs = isSeated ? [] : [turn(0, 0.09, kTrousers)];
  const body = [turn(0.47, 0.11, jacket), turn(0.74, 0.143, jacket), turn(0.81, 0.06, kSkin)];
  const face = isFine ? [turn(0.845, 0.045, kSkin), turn(0.875, 0.072, kSkin)] : [];
  const cap = [turn(0.935, 0.079, kCap), ...(isFine ? [turn(0.985, 0.06, kCap)] : []), turn(1.01, 0, kCap)];
  addTurned(builder, [x, y, z], [...legs, ...body, ...face, ...cap], isFine ? kSidesCount : kPlainSidesCount);
  if (!isFine) return;
  for (const side of [-1, 1]) {
    const at = (out: number, up: number, ahead: number): Point => [x + ahead * tallM, y + up * tallM - seatedM, z + side * out * tallM];
    const [shoulder, elbow, wrist] = [at(0.135, 0.755, 0), at(0.175, 0.6, 0.03), at(0.11, 0.555, 0.22)];
    addRod(builder, shoulder, elbow, 0.045 * tallM, jacket, 3, 0.038 * tallM);
    addRod(builder, elbow, wrist, 0.032 * tallM, kSkin, 3, 0.025 * tallM);
  }
}
