// Several tabs and several people at one scene, and things that a scene has several times.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { browser, draw, labelOf, lookFromFront, open, pixelOf, room, saved, select, selected, serve, told } from "./room.mjs";

/** Gives a piece a class by keys. */
async function give(page, name, key) {
    await page.locator("#stage").focus();
    await select(page, name);
    for (const pressed of [key, "Enter"]) await page.keyboard.press(pressed);
    await saved(page);
}

test("eight tabs share one stream of announcements, and all hear an edit", async (t) => {
    const { url } = await serve(t, room(t).file);
    const context = await (await browser(t)).newContext();
    const pages = [];
    for (let i = 0; i < 8; i++) {
        const page = await context.newPage();
        await page.goto(url);
        await page.waitForFunction(() => window.annotate !== undefined, null, { timeout: 30_000 });
        pages.push(page);
    }
    await give(pages[7], "chair_1", "5");
    for (const page of pages) await page.waitForFunction(() => window.annotate.state.pieces.semantic.includes(5), null, { timeout: 15_000 });
    await context.close();
});

test("undo is a person's own, and what others do shows by name", async (t) => {
    const { file, labels } = room(t);
    const { url } = await serve(t, file);
    const one = await browser(t);
    const [ada, ben] = [await open(one, url), await open(one, url)];
    for (const [page, name] of [[ada, "Ada"], [ben, "Ben"]]) {
        await page.getByRole("tab", { name: "History" }).click();
        await page.getByLabel("Your name").fill(name);
        await page.keyboard.press("Enter");
        assert.equal(await page.evaluate(() => window.annotate.edits.who), name);
    }
    await give(ada, "chair_1", "5");
    await give(ben, "table_1", "7");
    await ada.locator("#others", { hasText: "Ben: Class table on table_1" }).waitFor();
    await ada.locator("#panel-history .edit", { hasText: "Ben" }).waitFor();
    await ada.keyboard.press("Control+z");
    await saved(ada);
    assert.deepEqual([await labelOf(ada, "chair_1"), await labelOf(ada, "table_1")], [[-1, -1], [7, -1]], "Ben's stays");
    assert.equal(await ada.locator('[data-command="undo"]').isDisabled(), true);
    assert.equal(await ben.locator('[data-command="undo"]').isDisabled(), false);
    // Going back in the history is for everybody's, asks, and is told to whose it was.
    await ada.locator("#panel-history .edit", { hasText: "The beginning" }).click();
    await ada.getByText("Some are by Ben.").waitFor();
    await ada.getByRole("dialog").getByRole("button", { name: "Undo" }).click();
    await ben.locator(".toast", { hasText: "Ada: Undone: Class table on table_1" }).waitFor();
    await ben.keyboard.press("Control+Shift+z");
    await ada.waitForFunction(() => window.annotate.state.pieces.semantic.includes(7));
    // A review has a name too, and shows in the other tab without an edit.
    await select(ada, "floor");
    await ada.locator("#stage").focus();
    await ada.keyboard.press("Shift+d");
    await ben.waitForFunction(() => [...window.annotate.state.reviews.values()].some(({ who, state }) => who === "Ada" && state === "done"));
    const log = readFileSync(join(labels, "annotation_log.jsonl"), "utf8");
    assert.match(log, /"who":"Ben".*\n.*"who":"Ada".*"undo_of"/u);
});

/** Three desks, each of three boxes in a group. */
const desks = () =>
    [[-2.8, -2.5], [0, -2.5], [-2.8, -1.2]].flatMap(([x, y], i) => {
        const box = (name, [x0, y0, z0], [x1, y1, z1]) => [`desk_${i + 1}/${name}`, [[[x + x0, y + y0, z0], [x + x1, y + y1, z1]]]];
        return [box("top", [0, 0, 0.7], [1.2, 0.6, 0.74]), box("left", [0, 0, 0], [0.05, 0.6, 0.7]), box("right", [1.1, 0, 0], [1.15, 0.6, 0.7])];
    });

test("one key selects the whole object, one makes it a thing, and one labels its copies", async (t) => {
    const { file } = room(t, desks());
    const page = await open(await browser(t), (await serve(t, file)).url);
    await lookFromFront(page);
    await page.locator("#stage").focus();
    await select(page, "desk_1/left");
    await page.keyboard.press("Shift+w");
    assert.deepEqual(await selected(page), ["desk_1/left", "desk_1/right", "desk_1/top"]);
    await page.keyboard.press("Shift+w");
    await page.getByText("no larger object around the selection").waitFor();
    await select(page, "desk_1/top");
    for (const key of ["1", "4", "Control+Enter"]) await page.keyboard.press(key);
    await saved(page);
    assert.deepEqual([await labelOf(page, "desk_1/left"), await labelOf(page, "desk_1/right")], [[14, 1], [14, 1]]);
    await page.keyboard.press("Shift+s");
    await saved(page);
    await page.getByText("The same again: 2 copies of desk_1/top.").waitFor();
    assert.deepEqual([await labelOf(page, "desk_2/top"), await labelOf(page, "desk_2/left"), await labelOf(page, "desk_3/right")], [[14, 2], [14, 2], [14, 3]]);
    await page.keyboard.press("Control+z");
    await saved(page);
    assert.deepEqual(await labelOf(page, "desk_2/top"), [-1, -1]);
    await select(page, "wall_back");
    for (const key of ["1", "Enter", "Shift+s"]) await page.keyboard.press(key);
    await page.getByText('there is no copy of "wall_back"').waitFor();
});

test("the dot, and arrows in the view, tell where they lead", async (t) => {
    const page = await open(await browser(t), (await serve(t, room(t).file)).url);
    await page.waitForFunction(() => window.annotate.act.missing.semantic.length > 0);
    await page.locator("#stage").focus();
    await page.keyboard.press(".");
    assert.match(await told(page), /, no class, 1 of \d to do$/u);
    await lookFromFront(page);
    await page.keyboard.press("ArrowLeft");
    await page.waitForFunction(() => /in the middle/iu.test(document.getElementById("live").textContent));
    // The active row of a list is told too, and rows say what they show.
    await page.getByRole("tab", { name: "Pieces" }).click();
    const list = page.locator("#panel-pieces [role=listbox]");
    await list.focus();
    await page.keyboard.press("ArrowDown");
    const active = await list.getAttribute("aria-activedescendant");
    assert.equal(await page.locator(`#${active}`).getAttribute("aria-selected"), "true");
    assert.match(await page.locator(`#${active}`).textContent(), /none as class.*no instance.* m²$/u);
});

test("a view of the whole scene leaves the ground around it out", async (t) => {
    const page = await open(await browser(t), (await serve(t, room(t, [["ground", [[[-110, -110, -0.2], [110, 110, -0.15]]]]]).file)).url);
    await page.locator("#stage").focus();
    for (const key of ["Home", "End"]) {
        await page.keyboard.press(key);
        await page.waitForFunction(() => !window.annotate.stage.flight && window.annotate.stage.settled);
        const far = await page.evaluate(() => Math.hypot(...window.annotate.stage.camera.position.toArray()));
        assert.ok(far < 25, `${key}: the camera is ${far} m away`);
    }
});

test("erasing works by itself, and a class is given to what has an instance", async (t) => {
    const page = await open(await browser(t), (await serve(t, room(t).file)).url);
    await lookFromFront(page);
    await page.evaluate(() => window.annotate.edits.send({ type: "assign", pieces: [2], apply: { layer: "instance", new: true } }));
    const at = await pixelOf(page, "chair_1");
    await page.locator("#stage").focus();
    await page.keyboard.press("5");
    await draw(page, at, at);
    assert.deepEqual(await labelOf(page, "chair_1"), [5, 1]);
    await page.keyboard.press("e");
    await draw(page, at, at);
    assert.deepEqual(await labelOf(page, "chair_1"), [-1, 1]);
});

test("labels of an earlier version come along, and what found no part is listed", async (t) => {
    const { folder, file, labels } = room(t, [["stool", [[[2, 2, 0], [2.3, 2.3, 0.4]]]]]);
    const first = await serve(t, file);
    const before = await open(await browser(t), first.url);
    for (const [name, key] of [["chair_1", "5"], ["table_1", "7"], ["stool", "5"]]) await give(before, name, key);
    await before.close();
    await first.end();
    // Exported again: the stool is gone, and the table has another name.
    room(t, [], folder);
    writeFileSync(file, readFileSync(file, "utf8").replace("o table_1", "o desk"));
    const page = await open(await browser(t), (await serve(t, file, 0, "annotate", ["--carry", labels])).url);
    assert.deepEqual([await labelOf(page, "chair_1"), await labelOf(page, "desk")], [[5, -1], [7, -1]]);
    await page.getByRole("tab", { name: "Progress" }).click();
    const list = page.locator("#panel-progress .carried");
    await list.locator("dt", { hasText: "table_1 → desk" }).waitFor();
    assert.match(await list.innerText(), /stool\s+chair, not: no part has its name or shape/u);
    await page.getByRole("tab", { name: "History" }).click();
    await page.locator("#panel-history .edit", { hasText: "Carried over: the labels of 2 parts" }).waitFor();
});
