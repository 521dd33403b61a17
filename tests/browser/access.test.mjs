// Access: no finding of axe-core, everything by keyboard, nothing cut off at a zoom of 200 %, and the page in German.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, it } from "node:test";

import { kPhone, launch, skip, WAIT_MS, waitFor } from "./chromium.mjs";
import { layoutFaults } from "./layout_faults.mjs";
import { ended, startClass } from "./server.mjs";

const kAxe = readFileSync(new URL("node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
const kDesk = { viewport: { width: 1280, height: 720 } };

/** Windows of 1280 x 720 at a zoom of 200 %, and of a phone whose width is 320 CSS pixels. */
const kZoomed = {
  "a window at 200 %": { viewport: { width: 640, height: 360 }, deviceScaleFactor: 2 },
  "a phone of 320 px": { viewport: { width: 320, height: 692 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true },
};

const nothing = async () => {};
/** Steps through all that the page of the water shows. */
const kWaterStates = {
  "as it opens": nothing,
  "with the whole panel": async (page) => {
    await page.getByTestId("class-box").waitFor({ state: "attached", timeout: WAIT_MS });
    if (await page.evaluate(() => document.body.classList.contains("panel-closed"))) await page.locator("#panel-toggle").dispatchEvent("click");
    await page.evaluate(() => document.querySelectorAll("#panel details:not([hidden])").forEach((each) => (each.open = true)));
  },
  "with the panel closed": (page) => page.locator("#panel-toggle").dispatchEvent("click"),
  "with the share card": async (page) => {
    await page.getByTestId("share").dispatchEvent("click");
    await page.getByTestId("share-card").waitFor({ timeout: WAIT_MS });
  },
  "with the card of keys": async (page) => {
    await page.keyboard.press("Escape");
    await page.getByTestId("share-card").waitFor({ state: "hidden", timeout: WAIT_MS });
    await page.keyboard.press("?");
    await page.getByTestId("keys-card").waitFor({ timeout: WAIT_MS });
  },
};
const kPadStates = {
  "with a finger": nothing,
  "with the helm": (page) => page.getByTestId("pad-tool-boat").dispatchEvent("click"),
  "with the name": (page) => page.getByTestId("pad-me").dispatchEvent("click"),
};

describe("access", { skip, timeout: 20 * WAIT_MS, concurrency: 1 }, () => {
  let server;
  let token;
  let browser;

  before(async () => {
    ({ server, token } = await startClass());
    browser = await launch();
  });
  after(() => ended(browser, server));

  async function open(path, options) {
    const page = await (await browser.newContext(options)).newPage();
    page.setDefaultTimeout(WAIT_MS);
    page.on("pageerror", (error) => assert.fail(error));
    await page.goto(new URL(path, `http://127.0.0.1:${server.port}/`).href, { timeout: WAIT_MS });
    await waitFor(page, "water", ({ simTime, role }) => simTime > 0 && role !== "viewer");
    return page;
  }
  const water = (options, more = "") => open(`?quality=minimal${more}#token=${token}`, options);

  /** Rules of WCAG 2.2 A and AA, and best practices. */
  async function findings(page) {
    await page.evaluate(kAxe);
    const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
    return violations.map(({ id, help, nodes }) => `${id} (${help}): ${nodes.map(({ html, failureSummary }) => `${html.slice(0, 160)} ${failureSummary.replaceAll("\n", " ").slice(0, 200)}`).join(" | ")}`);
  }
  /** Opens a page, goes through its states, and expects that `faultsOf` finds nothing in any of them. */
  async function expectNone(faultsOf, opening, steps) {
    const page = await opening;
    const found = [];
    try {
      for (const [what, step] of Object.entries(steps)) {
        await step(page);
        found.push(...(await faultsOf(page)).map((each) => `${what}: ${each}`));
      }
    } finally {
      await page.context().close();
    }
    assert.deepEqual(found, []);
  }
  const isClean = (opening, steps) => expectNone(findings, opening, steps);
  /** Nothing is cut off, covered or on top of something else. */
  const fits = (opening, steps) => expectNone(layoutFaults, opening, steps);

  for (const [name, options] of Object.entries({ desk: kDesk, phone: kPhone })) {
    it(`has no finding on the water page: ${name}`, async () => {
      await isClean(water(options), kWaterStates);
    });

    it(`has no finding on the pad: ${name}`, async () => {
      await isClean(open("pad", options), kPadStates);
    });

    it(`has no finding on the projector's view: ${name}`, async () => {
      await isClean(open(`?class&quality=minimal#token=${token}`, options), {
        "with the code": (page) => page.getByTestId("join-card").waitFor({ timeout: WAIT_MS }),
        "with its controls": (page) => page.keyboard.press("Shift"),
      });
    });
  }

  it("is used by keyboard alone: splash, pause, step, view, the list of keys, the language", async () => {
    const page = await water(kDesk);
    const { keyboard } = page;
    const isFocused = (selector) => page.evaluate((wanted) => document.activeElement?.matches(wanted), selector);
    const tabTo = async (selector) => {
      for (let k = 0; k < 80; ++k) {
        if (await isFocused(selector)) return;
        await keyboard.press("Tab");
      }
      assert.fail(`80 presses of Tab do not reach ${selector}`);
    };
    try {
      await tabTo("#view");
      for (let k = 0; k < 4; ++k) await keyboard.press("ArrowLeft");
      await page.getByTestId("key-cursor").waitFor({ timeout: WAIT_MS }); // with the panels, after the first picture
      await keyboard.press("Enter");
      const { lastCommand } = await waitFor(page, "the splash", (stats) => stats.lastCommand?.case === "splash" && stats.lastAck);
      const middle = await page.evaluate(([x, z]) => window.spindrift.pixelOf(x, z), [lastCommand.value.xM, lastCommand.value.zM]);
      assert.ok(Math.abs(middle[0] - (640 - 4 * 16)) < 40, `the splash is at the cursor: ${middle}`);
      await keyboard.press("p");
      const { simTime } = await waitFor(page, "the pause", ({ paused }) => paused);
      await keyboard.press("n");
      await waitFor(page, "the step", (stats) => stats.lastCommand.case === "step" && stats.paused);
      const { view } = await waitFor(page, "a view", (stats) => stats.simTime >= simTime && stats.view !== null);
      await keyboard.press("v");
      await waitFor(page, "another view", (stats) => stats.view !== view);
      await keyboard.press("p");
      await waitFor(page, "the end of the pause", ({ paused }) => !paused);
      await keyboard.press("?");
      await page.getByTestId("keys-card").waitFor({ timeout: WAIT_MS });
      await keyboard.press("Enter");
      await page.getByTestId("keys-card").waitFor({ state: "hidden", timeout: WAIT_MS });
      await tabTo("#more-box > summary");
      await keyboard.press("Enter");
      await tabTo("#language");
      await keyboard.press("d");
      await page.waitForFunction(() => document.documentElement.lang === "de" && document.querySelector("#splash")?.textContent === "Platscher", null, { timeout: WAIT_MS });
    } finally {
      await page.context().close();
    }
  });

  for (const [name, options] of Object.entries(kZoomed))
    for (const locale of ["en-US", "de-DE"]) {
      const zoomed = { ...options, locale };
      it(`has no control cut off and no texts on one another, water page: ${name}, ${locale}`, async () => {
        await fits(water(zoomed), kWaterStates);
      });

      it(`has no control cut off and no texts on one another, front page: ${name}, ${locale}`, async () => {
        const page = await (await browser.newContext(zoomed)).newPage();
        await page.goto(`http://127.0.0.1:${server.port}/?room=nowhere#token=${token}`, { timeout: WAIT_MS });
        await fits(page, {
          "with a room that does not exist": async () => {
            await page.getByTestId("room-main").waitFor({ timeout: WAIT_MS });
            await page.getByTestId("front-open").waitFor({ timeout: WAIT_MS });
          },
        });
      });

      it(`has no control cut off and no texts on one another, pad: ${name}, ${locale}`, async () => {
        await fits(open("pad", zoomed), kPadStates);
      });
    }

  /** Everything of at least two words that the page shows or names, but what the server says. */
  const sentences = (page) =>
    page.evaluate(() => {
      const texts = new Set();
      document.querySelectorAll("details").forEach((each) => (each.open = true));
      for (const element of document.querySelectorAll("body *:not(script, style)")) {
        if (element.closest("#parameters, #storm, #device, #passes, #toast, .pad-name, [data-testid=pad-me], #people, .board-people, .lesson-people")) continue;
        for (const name of ["aria-label", "title"]) if (element.getAttribute(name)) texts.add(element.getAttribute(name));
        for (const node of element.childNodes) if (node.nodeType === Node.TEXT_NODE && element.checkVisibility()) texts.add(node.textContent.trim());
      }
      return [...texts].filter((text) => /[A-Za-z]{2,} [A-Za-z]{2,}/.test(text));
    });

  for (const [what, path] of Object.entries({ "water page": `?quality=minimal#token=`, "projector's view": "?class&quality=minimal#token=", pad: "pad#token=" })) {
    it(`has no sentence of the English page in German: ${what}`, async () => {
      const found = {};
      for (const locale of ["en-US", "de-DE"]) {
        const page = await open(path.replace("#token=", path.startsWith("pad") ? "" : `#token=${token}`), { ...kDesk, locale });
        assert.equal(await page.evaluate(() => document.documentElement.lang), locale.slice(0, 2));
        if (path.startsWith("pad")) await page.getByTestId("pad-tool-boat").dispatchEvent("click");
        else await page.getByTestId("class-box").waitFor({ state: "attached", timeout: WAIT_MS });
        found[locale] = await sentences(page);
        await page.context().close();
      }
      assert.ok(found["en-US"].length > (path.startsWith("pad") ? 2 : 20), JSON.stringify(found));
      assert.deepEqual(found["de-DE"].filter((text) => found["en-US"].includes(text)), []);
    });
  }
});
