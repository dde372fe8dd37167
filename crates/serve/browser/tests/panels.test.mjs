// The panels: suggestions in groups, history, review, recent classes.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { browser, labelOf, lookFromFront, open, room, saved, select, selected, serve, shown } from "./room.mjs";
import { stem } from "../../../label_page/web/annotate/names.js";
import { rowsOf } from "../../../label_page/web/annotate/suggestion_groups.js";

const openRoom = async (t) => {
    const place = room(t);
    const page = await open(await browser(t), (await serve(t, place.file)).url);
    await lookFromFront(page);
    return { page, ...place };
};
const tab = (page, name) => page.getByRole("tab", { name }).click();

test("numbers at the ends of words do not tell names apart", () => {
    const names = ["sofa_1/seat_cushion_2", "StickyNote3_Mesh075", "Wall 2 left", "2seater", "chair"];
    assert.deepEqual(names.map(stem), ["sofa/seat_cushion", "stickynote_mesh", "wall left", "2seater", "chair"]);
});

test("a class with several groups of suggestions has a row of its own before them", () => {
    const classes = [5, 7, 5, 5, 7];
    const rows = rowsOf(/** @type {any} */ ({ suggestion: (piece) => ({ semantic: classes[piece] }) }), [[0, 2], [3], [1, 4]]);
    assert.deepEqual([...rows], [[-5, [0, 2, 3]], [0, [0, 2]], [3, [3]], [1, [1, 4]]]);
});

test("suggestions show in the scene, and are confirmed and rejected in groups", async (t) => {
    const { page } = await openRoom(t);
    await tab(page, "Suggested");
    await page.locator('#panel-suggestions input[type="range"]').fill("0.3");
    const proposed = () => page.evaluate(() => [...window.annotate.state.proposed].map((piece) => window.annotate.state.name(piece)).sort());
    assert.deepEqual(await proposed(), ["chair_1", "chair_2", "floor", "lamps", "table_1", "wall_back"]);
    await page.getByTitle("Confirm chair for chair × 2").click();
    await saved(page);
    assert.deepEqual([(await labelOf(page, "chair_1"))[0], (await labelOf(page, "chair_2"))[0]], [5, 5]);
    await page.getByTitle("Reject table for table_1").click();
    assert.deepEqual(await proposed(), ["floor", "lamps", "wall_back"]);
    assert.equal((await labelOf(page, "table_1"))[0], -1);
    // A row is the whole group, and leaving the panel shows the scene as it is.
    await page.locator("#panel-suggestions .piece", { hasText: "lamps" }).click();
    assert.deepEqual(await selected(page), ["lamps"]);
    await page.keyboard.press("Shift+y");
    assert.deepEqual(await proposed(), ["floor", "wall_back"]);
    await tab(page, "Classes");
    assert.deepEqual(await proposed(), []);
    await page.reload();
    await shown(page);
    assert.equal(await page.evaluate(() => window.annotate.state.rejected.size), 2, "rejected for good");
});

test("the history goes back to an edit, and forward again", async (t) => {
    const { page } = await openRoom(t);
    await tab(page, "History");
    const rows = () => page.locator("#panel-history .edit .name").allInnerTexts();
    for (const [name, key] of [["chair_1", "5"], ["table_1", "7"], ["floor", "2"]]) {
        await select(page, name);
        await page.keyboard.press(key);
        await page.keyboard.press("Enter");
        await saved(page);
    }
    await page.locator("#panel-history .edit", { hasText: "floor" }).waitFor();
    assert.deepEqual(await rows(), ["Class floor on floor", "Class table on table_1", "Class chair on chair_1", "The beginning"]);
    // Several edits are undone only when that is confirmed.
    await page.locator("#panel-history .edit", { hasText: "chair_1" }).click();
    await page.getByText("Undo 2 edits?").waitFor();
    await page.getByRole("button", { name: "Cancel" }).click();
    await saved(page);
    assert.equal((await labelOf(page, "floor"))[0], 2);
    await page.locator("#panel-history .edit", { hasText: "chair_1" }).click();
    await page.getByRole("dialog").getByRole("button", { name: "Undo" }).click();
    await page.locator("#panel-history .edit.undone", { hasText: "floor" }).waitFor();
    await saved(page);
    const labels = async () => Promise.all(["chair_1", "table_1", "floor"].map(async (name) => (await labelOf(page, name))[0]));
    assert.deepEqual(await labels(), [5, -1, -1]);
    await page.locator("#panel-history .edit.undone", { hasText: "floor" }).click();
    await saved(page);
    assert.deepEqual(await labels(), [5, 7, 2]);
});

test("classes given last are at hand", async (t) => {
    const { page } = await openRoom(t);
    for (const [name, key] of [["chair_1", "5"], ["table_1", "7"]]) {
        await select(page, name);
        await page.keyboard.press(key);
        await page.keyboard.press("Enter");
        await saved(page);
    }
    assert.deepEqual(await page.locator(".recent .name").allInnerTexts(), ["table", "chair"]);
    await select(page, "chair_2");
    await page.locator(".recent button", { hasText: "chair" }).click();
    await saved(page);
    assert.equal((await labelOf(page, "chair_2"))[0], 5);
});

test("pieces are done, approved or in question, which is listed, kept and exported", async (t) => {
    const { page, labels } = await openRoom(t);
    await select(page, "chair_1");
    await page.keyboard.press("Shift+d");
    await page.waitForFunction(() => window.annotate.state.reviews.size === 1);
    await select(page, "table_1");
    await page.keyboard.press("Shift+q");
    await page.getByLabel("Question", { exact: true }).last().fill("desk, or table?");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => window.annotate.state.reviews.size === 2);
    assert.match(await page.locator("#current").innerText(), /question: desk, or table\?/);
    await tab(page, "To do");
    for (const [list, name] of [["question", "table_1"], ["done", "chair_1"]]) {
        await page.getByLabel("What is missing").selectOption(list);
        assert.deepEqual(await page.locator("#panel-unlabelled .piece > :first-child").allInnerTexts(), [name]);
    }
    await page.locator("#stage").focus();
    await page.keyboard.press(".");
    await page.keyboard.press("Shift+a");
    await page.getByText("Nothing is left to do here.").or(page.locator("#panel-unlabelled .list.none")).first().waitFor();
    const table = readFileSync(join(labels, "metadata_object_review.csv"), "utf8");
    assert.match(table, /^object_name,state,note,who\nchair_1,approved,,guest \d{4}\ntable_1,question,"desk, or table\?",guest \d{4}\n$/u);
});

test("long names keep every control of the side within the window", async (t) => {
    const long = "Wall_unit_with_shelves_and_two_doors_of_the_left_neighbour_0001";
    const folder = room(t, [[long, [[[-2.8, 2, 0], [-2.2, 2.6, 1]]]]]);
    const page = await open(await browser(t), (await serve(t, folder.file)).url);
    await lookFromFront(page);
    for (const width of [1440, 1000]) {
        await page.setViewportSize({ width, height: 900 });
        await select(page, long);
        for (const name of await page.getByRole("tab").allInnerTexts()) {
            await tab(page, name.trim());
            const outside = await page.evaluate(() => [...document.querySelectorAll("#side button, #side input")].filter((one) => one.checkVisibility() && one.getBoundingClientRect().right > innerWidth + 0.5).map((one) => one.textContent));
            assert.deepEqual(outside, [], `${name} at ${width}`);
        }
    }
});
