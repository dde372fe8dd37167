// What axe-core, the usual checker of accessibility, finds on both pages: nothing.

import axe from "axe-core";
import assert from "node:assert/strict";
import { test } from "node:test";
import { browser, dataset, derive, open, room, serve } from "./room.mjs";

/** What it finds in both themes: rule, and the element's beginning. @param {import("playwright-core").Page} page */
async function findings(page) {
    const found = [];
    for (const colorScheme of /** @type {const} */ (["light", "dark"])) {
        await page.emulateMedia({ colorScheme });
        await page.evaluate(axe.source);
        const { violations } = await page.evaluate(() => /** @type {any} */ (window).axe.run());
        found.push(...violations.flatMap(({ id, nodes }) => nodes.map(({ html }) => `${colorScheme}: ${id}: ${html.slice(0, 120)}`)));
    }
    return found;
}

test("axe finds nothing on the page that labels", async (t) => {
    const page = await open(await browser(t), (await serve(t, room(t).file)).url);
    assert.deepEqual(await findings(page), []);
    await page.keyboard.press("?");
    assert.deepEqual(await findings(page), []);
});

test("axe finds nothing on the page that shows a dataset", async (t) => {
    const path = dataset(t, ["--fixtures"]);
    derive(path);
    const { origin } = new URL((await serve(t, path, 0, "view")).url);
    const page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
    for (const hash of ["mode=gallery", "layer=color&tab=display", "layer=color&tab=objects", "layer=color&tab=frame", "layer=color&tab=views", "layer=color&tab=pairs&tracks=true", "mode=space"]) {
        await page.goto("about:blank");
        await page.goto(`${origin}/view/#${hash}`);
        await page.waitForSelector("body[data-ready=true]");
        assert.deepEqual(await findings(page), [], hash);
    }
});
