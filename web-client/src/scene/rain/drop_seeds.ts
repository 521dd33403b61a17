// Random positions of the drops of rain, for the vertex shaders. Pure.

/** Returns `count` times `copies` vertices of four floats: three random numbers of the drop (0..1), and the copy's number. */
export function makeDropSeeds(count: number, copies: number, random: () => number): Float32Array<ArrayBuffer> {
  const seeds = new Float32Array(count * copies * 4);
  for (let drop = 0, at = 0; drop < count; ++drop) {
    const numbers = [random(), random(), random()];
    for (let copy = 0; copy < copies; ++copy, at += 4) seeds.set([...numbers, copy], at);
  }
  return seeds;
}
