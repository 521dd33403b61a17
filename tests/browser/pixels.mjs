// Measures screenshots. The browser decodes the PNG, so no library is needed.

/** Draws a PNG in the page. @returns {Promise<import("playwright-core").JSHandle<OffscreenCanvasRenderingContext2D>>} */
const drawn = (page, png) =>
  page.evaluateHandle(async (base64) => {
    const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))]));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    return context;
  }, png.toString("base64"));

/** Returns a PNG of the middle of the canvas, which no panel covers. */
export async function shootWater(page) {
  const box = await page.locator("canvas").first().boundingBox();
  const clip = { x: box.x + box.width * 0.3, y: box.y + box.height * 0.43, width: box.width * 0.4, height: box.height * 0.32 };
  return page.screenshot({ clip, timeout: 120_000 });
}

/**
 * Measures one PNG, or one against another of the same size.
 * @returns {Promise<{colour_count: number, deviation: number, changed_ratio: number, brightness: number}>} different colours (of 4096),
 *   standard deviation of the brightness (0..128), share of pixels whose brightness differs by more than 6 of 255, mean brightness (0..255)
 */
export async function measure(page, png, other = png) {
  return page.evaluate(
    (pictures) => {
      const [a, b] = pictures.map((picture) => picture.getImageData(0, 0, picture.canvas.width, picture.canvas.height).data);
      const brightness = (data, i) => 0.2126 * data[i] + 0.7152 * data[i + 1] + 0.0722 * data[i + 2];
      const colours = new Set();
      let sum = 0;
      let squares = 0;
      let changed = 0;
      for (let i = 0; i < a.length; i += 4) {
        colours.add(((a[i] >> 4) << 8) | ((a[i + 1] >> 4) << 4) | (a[i + 2] >> 4));
        const value = brightness(a, i);
        sum += value;
        squares += value * value;
        if (Math.abs(value - brightness(b, i)) > 6) changed += 1;
      }
      const count = a.length / 4;
      const mean = sum / count;
      return { colour_count: colours.size, deviation: Math.sqrt(Math.max(0, squares / count - mean * mean)), changed_ratio: changed / count, brightness: mean };
    },
    [await drawn(page, png), await drawn(page, other)],
  );
}

/** Returns red, green and blue (0..255) of one pixel of a PNG. */
export async function colourAt(page, png, x, y) {
  return page.evaluate(([picture, ...at]) => [...picture.getImageData(...at, 1, 1).data].slice(0, 3), [await drawn(page, png), Math.round(x), Math.round(y)]);
}

/** Returns the brightness (0..255) of a PNG at points in pixels, each the mean of 3 x 3. */
export async function brightnessAt(page, png, points) {
  return page.evaluate(
    ([picture, places]) =>
      places.map(([x, y]) => {
        const { data } = picture.getImageData(Math.round(x) - 1, Math.round(y) - 1, 3, 3);
        let sum = 0;
        for (let i = 0; i < data.length; i += 4) sum += 0.2126 * data[i] + 0.7152 * data[i + 1] + 0.0722 * data[i + 2];
        return sum / 9;
      }),
    [await drawn(page, png), points],
  );
}

/**
 * Measures a body of water on a floor: its pixels are those that are bluer than red by more than 12 of 255.
 * @returns {Promise<{water_ratio: number, filled_ratio: number, roughness: number}>} share of water in the picture; share of water
 *   between the first and the last water pixel of each row; mean difference of a water pixel's brightness to the mean of those 4 px
 *   left, right, above and below (0..255), where all of them are water
 */
export async function measureBody(page, png) {
  return page.evaluate((picture) => {
    const { width, height } = picture.canvas;
    const { data } = picture.getImageData(0, 0, width, height);
    const isWater = (x, y) => data[4 * (y * width + x) + 2] - data[4 * (y * width + x)] > 12;
    const brightness = (x, y) => [0.2126, 0.7152, 0.0722].reduce((sum, share, i) => sum + share * data[4 * (y * width + x) + i], 0);
    const apart = 4;
    const around = [[apart, 0], [-apart, 0], [0, apart], [0, -apart]];
    let water = 0;
    let between = 0;
    let inner = 0;
    let rough = 0;
    for (let y = 0; y < height; ++y) {
      const row = [];
      for (let x = 0; x < width; ++x) if (isWater(x, y)) row.push(x);
      if (row.length === 0) continue;
      water += row.length;
      between += row.at(-1) - row[0] + 1;
      for (const x of row) {
        const beside = around.map(([dx, dy]) => [x + dx, y + dy]);
        if (!beside.every(([i, k]) => i >= 0 && i < width && k >= 0 && k < height && isWater(i, k))) continue;
        ++inner;
        rough += Math.abs(brightness(x, y) - beside.reduce((sum, [i, k]) => sum + brightness(i, k), 0) / 4);
      }
    }
    return { water_ratio: water / (width * height), filled_ratio: water / Math.max(between, 1), roughness: rough / Math.max(inner, 1) };
  }, await drawn(page, png));
}
