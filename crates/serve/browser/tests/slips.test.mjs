// No label is given by a slip of a key or a click, and none is lost.

import assert from "node:assert/strict";
import { test } from "node:test";
import { browser, drag, labelOf, lookFromFront, open, pictureAt, pixelOf, room, saved, select, selected, serve } from "./room.mjs";

const openRoom = async (t) => {
    const page = await open(await browser(t), (await serve(t, room(t).file)).url);
    await lookFromFront(page);
    return page;
};
const stateOf = (page, name) => page.evaluate((value) => window.annotate.state[value], name);

test("digits end by any other key", async (t) => {
    const page = await openRoom(t);
    await page.waitForFunction(() => window.annotate.act.unlabelled.length > 0);
    await page.locator("#stage").focus();
    const [first, second] = await page.evaluate(() => window.annotate.act.unlabelled.map(({ name }) => name));
    for (const key of [".", "1", "Enter", ".", "2", "Enter"]) await page.keyboard.press(key);
    await saved(page);
    assert.deepEqual([(await labelOf(page, first))[0], (await labelOf(page, second))[0]], [1, 2]);
    // A click ends them too: 1, then 2 on another piece.
    await lookFromFront(page);
    await page.keyboard.press("1");
    await page.mouse.click(...(await pixelOf(page, "chair_1")));
    await page.keyboard.press("2");
    assert.equal(await stateOf(page, "currentClass"), 2);
});

test("keys that come before the server's answer are for what is seen when they are pressed", async (t) => {
    const page = await openRoom(t);
    await page.waitForFunction(() => window.annotate.act.unlabelled.length > 2);
    const [first, second, third] = await page.evaluate(() => window.annotate.act.unlabelled.map(({ name }) => name));
    await page.route("**/api/annotate/edit", async (route) => {
        await new Promise((answer) => setTimeout(answer, 300));
        await route.continue();
    });
    await page.locator("#stage").focus();
    for (const key of [".", "2", "2", "Shift+Enter", "1", "Shift+Enter", "3", "Enter"]) await page.keyboard.press(key);
    await saved(page);
    assert.deepEqual([(await labelOf(page, first))[0], (await labelOf(page, second))[0], (await labelOf(page, third))[0]], [22, 1, 3]);
});

test("no class is given that nobody chose", async (t) => {
    const page = await openRoom(t);
    await select(page, "chair_1");
    await page.keyboard.press("Shift+Enter");
    await page.getByText("No class is chosen.").waitFor();
    assert.deepEqual(await labelOf(page, "chair_1"), [-1, -1]);
    // In the layer of instances, what is given is told.
    for (const key of ["5", "Enter", " ", "Shift+Enter"]) await page.keyboard.press(key);
    await page.getByText("chair: a new thing.").waitFor();
});

test("a class for the pen is not given to the selection", async (t) => {
    const page = await openRoom(t);
    await select(page, "chair_1");
    await page.keyboard.press("p");
    await page.locator('[data-class="5"]').first().click();
    await saved(page);
    assert.deepEqual([(await labelOf(page, "chair_1"))[0], await stateOf(page, "currentClass")], [-1, 5]);
});

test("Backspace after a number and a pause takes the number back, not the label", async (t) => {
    const page = await openRoom(t);
    await select(page, "chair_1");
    for (const key of ["5", "Enter"]) await page.keyboard.press(key);
    await saved(page);
    await page.keyboard.press("7");
    await page.waitForTimeout(1200);
    await page.keyboard.press("Backspace");
    await saved(page);
    assert.deepEqual([(await labelOf(page, "chair_1"))[0], await stateOf(page, "currentClass")], [5, 5]);
    await page.keyboard.press("Backspace");
    await saved(page);
    assert.equal((await labelOf(page, "chair_1"))[0], -1);
});

test("the row below one that was labelled, and is gone, is the next one", async (t) => {
    const page = await openRoom(t);
    await page.getByRole("tab", { name: "To do" }).click();
    await page.waitForFunction(() => window.annotate.act.unlabelled.length > 2);
    const [first, second] = await page.evaluate(() => window.annotate.act.unlabelled.map(({ name }) => name));
    await page.locator('#panel-unlabelled [role="option"]').first().click();
    assert.deepEqual(await selected(page), [first]);
    for (const key of ["5", "Enter"]) await page.keyboard.press(key);
    await saved(page);
    await page.getByRole("listbox", { name: "To do" }).focus();
    await page.keyboard.press("ArrowDown");
    assert.deepEqual(await selected(page), [second]);
});

test("digits show while they are typed, and can be taken back", async (t) => {
    const page = await openRoom(t);
    const shown = page.locator("#typed");
    await select(page, "chair_1");
    await page.keyboard.press("4");
    assert.match(await shown.innerText(), /4_\s*bed/);
    await page.keyboard.press("0");
    assert.match(await shown.innerText(), /40_\s*otherprop/);
    await page.keyboard.press("Backspace");
    assert.match(await shown.innerText(), /4_\s*bed/);
    await page.keyboard.press("Escape");
    assert.equal(await shown.isVisible(), false);
    assert.equal(await stateOf(page, "layer"), "instance", "what was before the number");
    assert.deepEqual(await selected(page), ["chair_1"]);
});

test("a number that is no class is refused in sight and gives nothing", async (t) => {
    const page = await openRoom(t);
    await select(page, "chair_1");
    for (const key of ["5", "Enter"]) await page.keyboard.press(key);
    await saved(page);
    for (const key of ["9", "9"]) await page.keyboard.press(key);
    assert.match(await page.locator("#typed").innerText(), /99_\s*no class has this number/);
    await page.keyboard.press("Enter");
    await page.getByText("No class has the number 99").first().waitFor();
    assert.match(await page.locator("#label-now").innerText(), /99\s*no class has this number/);
    await page.mouse.click(...(await pixelOf(page, "table_1")));
    await page.keyboard.press("Enter");
    await saved(page);
    assert.deepEqual([(await labelOf(page, "chair_1"))[0], (await labelOf(page, "table_1"))[0]], [5, -1]);
});

test("a class that is clicked is given to the selection, and keys go on to the view", async (t) => {
    const page = await openRoom(t);
    await select(page, "chair_1");
    await page.locator('[data-class="5"]').first().click();
    await saved(page);
    assert.equal((await labelOf(page, "chair_1"))[0], 5);
    await page.mouse.click(...(await pixelOf(page, "chair_2")));
    await page.keyboard.press("Enter");
    await saved(page);
    assert.equal((await labelOf(page, "chair_2"))[0], 5, "Enter is for the selection, not for the button");
    await page.getByRole("button", { name: "Undo" }).click();
    await saved(page);
    await page.keyboard.press("Enter");
    await saved(page);
    assert.deepEqual([(await labelOf(page, "chair_1"))[0], (await labelOf(page, "chair_2"))[0]], [5, 5], "Enter does not undo again");
});

test("a selected piece keeps its colour, shows its new one at once, and is hatched in a colour of its own", async (t) => {
    const page = await openRoom(t);
    const [x, y] = await pixelOf(page, "chair_1");
    const at = [x + 14, y + 20];
    await page.mouse.move(700, 100);
    const plain = await pictureAt(page, at);
    await select(page, "chair_1");
    const chosen = await pictureAt(page, at);
    const kept = chosen.filter((rgb, i) => String(rgb) === String(plain[i])).length;
    assert.ok(kept > 0.7 * plain.length && kept < plain.length, `${kept} of ${plain.length}`);
    const magenta = ([r, g, b]) => r > 150 && g < 100 && b > 80;
    assert.ok(chosen.some(magenta) && !plain.some(magenta));
    await page.locator('[data-class="5"]').first().click();
    await saved(page);
    // Chairs are olive: much green and little blue.
    const olive = (await pictureAt(page, at)).filter(([r, g, b]) => g > 2 * b && Math.abs(r - g) < 30).length;
    assert.ok(olive > 0.7 * plain.length, `${olive} of ${plain.length}`);
    await page.evaluate(() => window.annotate.state.select([]));
    const labelled = await pictureAt(page, at);
    assert.ok(new Set(labelled.map(String)).size < new Set(plain.map(String)).size, "only what has no label is hatched");
});

test("erasing paint ends with the key or with painting, and what was painted is selected", async (t) => {
    const page = await openRoom(t);
    await select(page, "table_1");
    await page.keyboard.press("m");
    const [x, y] = await pixelOf(page, "table_1");
    await drag(page, [x, y], [x + 3, y]);
    await page.waitForFunction(() => window.annotate.state.painting.faces.size > 0);
    await page.keyboard.down("e");
    await drag(page, [x, y], [x + 3, y]);
    await page.waitForFunction(() => window.annotate.state.painting.faces.size === 0);
    await page.waitForTimeout(400);
    await page.keyboard.up("e");
    assert.equal(await page.evaluate(() => window.annotate.state.painting.erase), false);
    await drag(page, [x, y], [x + 3, y]);
    await page.waitForFunction(() => window.annotate.state.painting.faces.size > 0);
    await page.keyboard.press("e");
    await page.keyboard.press("Enter");
    await saved(page);
    assert.equal(await stateOf(page, "erase"), false, "labels are not erased after the paint was");
    assert.deepEqual(await selected(page), ["table_1~2"]);
});

test("an edit that the server refuses to take stays, in sight, until it is taken", async (t) => {
    const page = await openRoom(t);
    const body = { error: "the token is missing or wrong", help: "open the whole address that the program printed" };
    for (const answer of [(route) => route.fulfill({ status: 403, json: body }), (route) => route.fulfill({ status: 500, json: { error: "no room" } }), (route) => route.abort()]) {
        await page.route("**/api/annotate/edit", answer);
        await select(page, "chair_1");
        await page.keyboard.press(await page.evaluate(() => String(window.annotate.state.pieces.semantic[2] === 5 ? 6 : 5)));
        await page.keyboard.press("Enter");
        await page.locator("#offline").waitFor({ state: "visible" });
        assert.match(await page.locator("#offline").innerText(), /1 edit kept here; trying again/);
        assert.equal(await page.locator("#save-state").innerText(), "1 edit unsaved");
        const before = (await labelOf(page, "chair_1"))[0];
        await page.unroute("**/api/annotate/edit");
        await page.locator("#offline").waitFor({ state: "hidden" });
        await saved(page);
        assert.notEqual((await labelOf(page, "chair_1"))[0], before);
        assert.equal(await page.locator("#save-state").innerText(), "All saved");
    }
});

test("what can never be done is told, and is not called saved", async (t) => {
    const page = await openRoom(t);
    await page.evaluate(() => window.annotate.edits.send({ type: "undo" }));
    assert.equal(await page.locator("#save-state").innerText(), "Last edit refused");
    await page.getByText("there is nothing to undo").waitFor();
});
