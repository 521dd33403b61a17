// Pictures of the page at low quality against the kept ones: every shipped scene as it is seen first, the harbor in every light. `./dev
// gallery` makes them at high quality, too, and keeps new ones (docs/contributing.md).
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";

import { launch, skip } from "./chromium.mjs";
import { compare, described } from "./gallery/compare.mjs";
import { DrivenPage } from "./gallery/driven_page.mjs";
import { check, differencePath, kFile, keptPath, kKept, kPosters, madePath, makePictures, nameOf } from "./gallery/pictures.mjs";
import { lightsOf, kSize, sceneOf, setUp, shippedScenes, shotOf } from "./gallery/shots.mjs";

const kWaitMs = 600_000;

/** Returns a picture with its red, green and blue multiplied. */
function tinted(page, file, factors) {
  return page
    .evaluate(
      async ([encoded, by, { type, quality }]) => {
        const bytes = Uint8Array.from(atob(encoded), (letter) => letter.charCodeAt(0));
        const bitmap = await createImageBitmap(new Blob([bytes]));
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
        const drawing = canvas.getContext("2d");
        drawing.drawImage(bitmap, 0, 0);
        const image = drawing.getImageData(0, 0, bitmap.width, bitmap.height);
        for (let i = 0; i < image.data.length; ++i) if (i % 4 < 3) image.data[i] *= by[i % 4];
        drawing.putImageData(image, 0, 0);
        return canvas.toDataURL(type, quality).split(",")[1];
      },
      [file.toString("base64"), factors, kFile],
    )
    .then((base64) => Buffer.from(base64, "base64"));
}

/** In the page: returns the boat that is seen nearest to the middle of the picture. */
function seenBoat() {
  const away = ({ xM, zM }) => {
    const [xPx, yPx] = window.spindrift.pixelOf(xM, zM);
    return Math.hypot(xPx - innerWidth / 2, yPx - innerHeight / 2);
  };
  return window.spindrift.stats().boats.sort((a, b) => away(a) - away(b))[0].boatId;
}

describe("pictures of the shipped scenes", { concurrency: 1, skip }, () => {
  let browser;
  let context;
  let scratch;

  before(async () => {
    browser = await launch();
    context = await browser.newContext();
    scratch = await context.newPage();
  });
  after(() => browser?.close());

  for (const scene of shippedScenes())
    it(`${scene} looks as kept`, { timeout: kWaitMs }, async () => {
      const different = [];
      for await (const { name, file } of makePictures(context, { scene, quality: "low", lights: lightsOf(scene) })) {
        const difference = await check(scratch, name, file);
        if (!difference) different.push(`${name}: none is kept; look at ${madePath(name)}, then run ./dev gallery --update`);
        else if (!difference.isLike) different.push(`${name}: ${described(difference)}\n  made ${madePath(name)}\n  kept ${keptPath(name)}\n  places ${differencePath(name)}`);
      }
      assert.ok(different.length === 0, different.join("\n"));
    });

  it("tells a later tick, a missing boat and another colour from the kept picture", { timeout: kWaitMs }, async () => {
    const kept = readFileSync(keptPath(nameOf("low", "harbor", "noon")));
    const page = await DrivenPage.open(context, { scene: "harbor", quality: "low", size: kSize });
    try {
      const shot = shotOf("harbor");
      await setUp(page, shot);
      const same = await page.picture(kFile);
      const changed = { "3 % brighter": await tinted(scratch, same, [1.03, 1.03, 1.03]), "8 % less blue": await tinted(scratch, same, [1, 1, 0.92]) };
      const boatId = await page.evaluate(seenBoat);
      await page.command({ remove_boat: { boat_id: boatId } });
      // The page hears of it a moment later.
      let without = same;
      for (const deadlineMs = Date.now() + kWaitMs / 4; without.equals(same) && Date.now() < deadlineMs; ) without = await page.picture(kFile);
      changed["a boat less"] = without;
      await page.followTo(shot.tick + 6, 6);
      changed["6 ticks later"] = await page.picture(kFile);
      for (const [what, file] of Object.entries(changed)) {
        const difference = await compare(scratch, same, file);
        assert.ok(!difference.isLike, `${what}: ${described(difference)}`);
      }
      assert.ok((await compare(scratch, kept, same)).isLike);
    } finally {
      await page.close();
    }
  });

  it("keeps only pictures of shipped scenes", () => {
    for (const quality of readdirSync(kKept)) assert.deepEqual(readdirSync(join(kKept, quality)).filter((file) => !sceneOf(file)), []);
    assert.deepEqual(readdirSync(kPosters).filter((file) => !shippedScenes().includes(file.replace(".webp", ""))), []);
  });
});
