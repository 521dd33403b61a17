// Access: no finding of axe-core, everything by keyboard, and the page in German.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, it } from "node:test";

import { chromium } from "playwright-core";

import { executable, kChromiumArgs } from "./chromium.mjs";
import { startClass } from "./server.mjs";
import { skip, waitFor, WAIT_MS } from "./two_people.mjs";

const kAxe = readFileSync(new URL("node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
const kDesk = { viewport: { width: 1280, height: 720 } };
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

describe("access", { skip, timeout: 20 * WAIT_MS, concurrency: 1 }, () => {
  let server;
  let token;
  let browser;

  before(async () => {
    ({ server, token } = await startClass());
    browser = await chromium.launch({ executablePath: executable, args: kChromiumArgs });
  });
  after(async () => {
    await browser?.close();
    await server?.stop("SIGTERM");
  });

  async function open(path, options) {
    const page = await (await browser.newContext(options)).newPage();
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
  /** Opens a page, goes through its states, and expects no finding in any of them. */
  async function isClean(opening, steps) {
    const page = await opening;
    const found = [];
    try {
      for (const [what, step] of Object.entries(steps)) {
        await step(page);
        found.push(...(await findings(page)).map((each) => `${what}: ${each}`));
      }
    } finally {
      await page.context().close();
    }
    assert.deepEqual(found, []);
  }
  const nothing = async () => {};

  for (const [name, options] of Object.entries({ desk: kDesk, phone: kPhone })) {
    it(`has no finding on the water page: ${name}`, async () => {
      await isClean(water(options), {
        "as it opens": nothing,
        "with the whole panel": async (page) => {
          await page.getByTestId("class-box").waitFor({ state: "attached", timeout: WAIT_MS });
          if (name === "phone") await page.locator("#panel-toggle").dispatchEvent("click");
          await page.evaluate(() => document.querySelectorAll("#panel details:not([hidden])").forEach((each) => (each.open = true)));
        },
        "with the panel closed": (page) => page.locator("#panel-toggle").dispatchEvent("click"),
        "with the share card": async (page) => {
          await page.getByTestId("share").dispatchEvent("click");
          await page.getByTestId("share-card").waitFor({ timeout: WAIT_MS });
        },
        "with the card of keys": async (page) => {
          await page.keyboard.press("Escape");
          await page.keyboard.press("?");
          await page.getByTestId("keys-card").waitFor({ timeout: WAIT_MS });
        },
      });
    });

    it(`has no finding on the pad: ${name}`, async () => {
      await isClean(open("pad", options), {
        "with a finger": nothing,
        "with the helm": (page) => page.getByTestId("pad-tool-boat").dispatchEvent("click"),
        "with the name": (page) => page.getByTestId("pad-me").dispatchEvent("click"),
      });
    });

    it(`has no finding on the projector's view: ${name}`, async () => {
      await isClean(open(`?class&quality=minimal#token=${token}`, options), {
        "with the code": (page) => page.getByTestId("join-card").waitFor({ timeout: WAIT_MS }),
        "with its controls": (page) => page.keyboard.press("Shift"),
      });
    });
  }
});
