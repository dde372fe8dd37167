// What axe-core, the usual checker of accessibility, finds on both pages: nothing.

import axe from "axe-core";
import assert from "node:assert/strict";
import { test } from "node:test";
import { browser, dataset, derive, open, room, saved, select, serve } from "./room.mjs";

/** Rules that axe does not apply by itself. */
const RULES = { "target-size": { enabled: true }, "label-content-name-mismatch": { enabled: true } };

/** What it finds in both themes: rule, and the element's beginning. @param {import("playwright-core").Page} page @param {string} [within] the part of the page that is looked at */
async function findings(page, within = "html") {
    const found = [];
    for (const colorScheme of /** @type {const} */ (["light", "dark"])) {
        await page.emulateMedia({ colorScheme });
        if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axe.source);
        const { violations } = await page.evaluate(([context, rules]) => /** @type {any} */ (window).axe.run(context, { rules, resultTypes: ["violations"] }), /** @type {const} */ ([within, RULES]));
        found.push(...violations.flatMap(({ id, nodes }) => nodes.map(({ html }) => `${colorScheme}: ${id}: ${html.slice(0, 120)}`)));
    }
    return found;
}

/** Shows a panel of the page that labels. @param {import("playwright-core").Page} page @param {string} name */
const tab = (page, name) => page.getByRole("tab", { name, exact: true }).click();
const DIALOG = "dialog[open]";
const TABS = ["Classes", "Pieces", "Suggested", "To do", "History", "Progress"];

test("axe finds nothing on the page that labels", async (t) => {
    const page = await open(await browser(t), (await serve(t, room(t).file)).url);
    const check = async (what, within) => assert.deepEqual(await findings(page, within), [], what);
    await check("all of it");
    for (const name of TABS) {
        await tab(page, name);
        await check(`${name}, at the beginning`, "#side");
    }
    for (const [name, key] of [["chair_1", "5"], ["table_1", "7"], ["floor", "2"]]) {
        await select(page, name);
        for (const pressed of [key, "Shift+Enter"]) await page.keyboard.press(pressed);
        await saved(page);
    }
    await select(page, "chair_1");
    await page.keyboard.press("Shift+q");
    await check("the question", DIALOG);
    await page.getByLabel("Question", { exact: true }).last().fill("a stool?");
    await page.keyboard.press("Enter");
    for (const name of TABS) {
        await tab(page, name);
        await check(`${name}, with labels`, "#side");
    }
    await page.locator("#panel-pieces input").evaluate((input) => {
        input.value = "nothing has this name";
        input.dispatchEvent(new Event("input"));
    });
    await tab(page, "Pieces");
    await check("an empty list", "#panel-pieces");
    await tab(page, "History");
    await page.locator("#panel-history .edit", { hasText: "The beginning" }).click();
    await check("the question before much is undone", DIALOG);
    await page.keyboard.press("Escape");
    await page.locator("#stage").focus();
    for (const [key, what] of [["?", "the help"], ["Control+k", "the commands"], ["Shift+v", "the settings"]]) {
        await page.keyboard.press(key);
        await check(what, DIALOG);
        await page.keyboard.press("Escape");
    }
});

test("axe finds nothing on the page that shows a dataset", async (t) => {
    const path = dataset(t, ["--fixtures"]);
    derive(path);
    const { origin } = new URL((await serve(t, path, 0, "view")).url);
    const page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
    const tabs = ["display", "objects", "frame", "views", "pairs"].map((tab) => `layer=color&tab=${tab}`);
    const modes = ["mode=side", "mode=wipe", "mode=difference", "mode=space", "mode=gallery", "mode=gallery&show=every", "mode=gallery&show=tagged"];
    for (const hash of [...tabs, "layer=color&tracks=true&track=3&ruler=10,20,90,60", "layer=semantic&tab=objects&instance=1", ...modes]) {
        await page.goto("about:blank");
        await page.goto(`${origin}/view/#${hash}`);
        await page.waitForSelector("body[data-ready=true]");
        assert.deepEqual(await findings(page), [], hash);
    }
    await page.goto(`${origin}/view/#mode=gallery`);
    await page.locator("#gallery-frames .place").first().waitFor();
    for (const key of ["h", "ArrowRight", "r"]) await page.keyboard.press(key);
    await page.locator("#marks-python").waitFor();
    assert.deepEqual(await findings(page), [], "frames of one's own list");
    await page.goto(`${origin}/view/#layer=color`);
    for (const [key, what] of [["?", "the help"], ["Control+k", "the search of layers"]]) {
        await page.keyboard.press(key);
        assert.deepEqual(await findings(page, DIALOG), [], what);
        await page.keyboard.press("Escape");
    }
});
