// How far two pictures are apart, to the eye: the share of pixels whose colours differ by more than a threshold in the colour space YIQ, as
// weighted by Kotsarenko and Ramos, "Measuring perceived color difference using YIQ NTSC transmission color space in mobile applications"
// (2010). pixelmatch computes it; Chromium decodes and encodes the files.
import pixelmatch from "pixelmatch";

/**
 * Two limits, because defects are of two kinds. `faint`: means over squares of 4 x 4 pixels differ by more than 0.015 (of 1, black to
 * white; a grey step of 4 of 255) in at most 0.5 % of the picture: another colour of the water. `strong`: single pixels differ by more than
 * 0.1 in at most 0.05 %: a boat that is missing. Means keep the noise of lossy files out of the first, its size out of the second.
 */
export const kLimits = { faint: { meanOfPx: 4, threshold: 0.015, share: 0.005 }, strong: { meanOfPx: 1, threshold: 0.1, share: 0.0005 } };

/** Decodes a picture in a page of Chromium. @returns {Promise<{width: number, height: number, data: Uint8Array}>} RGBA */
async function decode(page, file) {
  const { width, height, base64 } = await page.evaluate(async (encoded) => {
    const bytes = Uint8Array.from(atob(encoded), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes]));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    const url = await new Promise((done) => {
      const reader = new FileReader();
      reader.onload = () => done(reader.result);
      reader.readAsDataURL(new Blob([data]));
    });
    return { width: bitmap.width, height: bitmap.height, base64: url.slice(url.indexOf(",") + 1) };
  }, file.toString("base64"));
  return { width, height, data: new Uint8Array(Buffer.from(base64, "base64")) };
}

/** Returns the means over squares of `n` x `n` pixels; what is left at the right and below is dropped. */
function averaged({ width, height, data }, n) {
  if (n === 1) return { width, height, data };
  const out = { width: Math.floor(width / n), height: Math.floor(height / n) };
  out.data = new Uint8Array(4 * out.width * out.height);
  for (let y = 0; y < out.height; ++y)
    for (let x = 0; x < out.width; ++x)
      for (let channel = 0; channel < 4; ++channel) {
        let sum = 0;
        for (let row = 0; row < n; ++row) for (let column = 0; column < n; ++column) sum += data[4 * ((y * n + row) * width + x * n + column) + channel];
        out.data[4 * (y * out.width + x) + channel] = Math.round(sum / (n * n));
      }
  return out;
}

/**
 * Compares two files.
 * @returns {Promise<{faint: number, strong: number, isLike: boolean, mask?: {width: number, height: number, data: Uint8Array}}>} shares of
 *   the picture that differ, 1 if the sizes do; and a picture of the places, red over grey
 */
export async function compare(page, kept, made) {
  const [a, b] = [await decode(page, kept), await decode(page, made)];
  if (a.width !== b.width || a.height !== b.height) return { faint: 1, strong: 1, isLike: false };
  const shares = {};
  let mask;
  for (const [kind, { meanOfPx, threshold }] of Object.entries(kLimits)) {
    const [from, to] = [averaged(a, meanOfPx), averaged(b, meanOfPx)];
    const data = new Uint8Array(from.data.length);
    const count = pixelmatch(from.data, to.data, data, from.width, from.height, { threshold, includeAA: true });
    shares[kind] = count / (from.width * from.height);
    if (shares[kind] > kLimits[kind].share || !mask) mask = { width: from.width, height: from.height, data };
  }
  return { ...shares, isLike: Object.entries(kLimits).every(([kind, { share }]) => shares[kind] <= share), mask };
}

/** Returns a picture's file as one of another type. @param {{type: string, quality: number}} as */
export async function encodedAs(page, file, { type, quality }) {
  const base64 = await page.evaluate(
    async ([encoded, wanted, share]) => {
      const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(encoded), (letter) => letter.charCodeAt(0))]));
      const canvas = Object.assign(document.createElement("canvas"), { width: bitmap.width, height: bitmap.height });
      canvas.getContext("2d").drawImage(bitmap, 0, 0);
      return canvas.toDataURL(wanted, share).split(",")[1];
    },
    [file.toString("base64"), type, quality],
  );
  return Buffer.from(base64, "base64");
}

const percent = (share) => `${(100 * share).toFixed(2)} %`;

/** Returns the measured shares as text, with their limits. */
export function described({ faint, strong }) {
  return `faint ${percent(faint)} (at most ${percent(kLimits.faint.share)}), strong ${percent(strong)} (at most ${percent(kLimits.strong.share)})`;
}

/** Returns RGBA as a PNG file. */
export async function encodePng(page, { width, height, data }) {
  const base64 = await page.evaluate(
    async ([columns, rows, encoded]) => {
      const bytes = Uint8ClampedArray.from(atob(encoded), (letter) => letter.charCodeAt(0));
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [columns, rows];
      canvas.getContext("2d").putImageData(new ImageData(bytes, columns, rows), 0, 0);
      return canvas.toDataURL("image/png").split(",")[1];
    },
    [width, height, Buffer.from(data).toString("base64")],
  );
  return Buffer.from(base64, "base64");
}
