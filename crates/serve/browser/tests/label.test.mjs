// A room is labelled from nothing; what stands on the disk is what was drawn.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { browser, draw, labelOf, lookFromFront, open, pixelOf, room, saved, serve, told } from "./room.mjs";

test("strokes label a room, and the files say so", async (t) => {
    const { file, labels } = room(t);
    const server = await serve(t, file);
    const page = await open(await browser(t), server.url);
    await lookFromFront(page);
    // Class by its number, then a click with the pen on each thing.
    await page.keyboard.press("p");
    for (const [name, id] of [["floor", 2], ["wall_back", 1], ["chair_1", 5], ["chair_2", 5], ["table_1", 7]]) {
        for (const digit of String(id)) await page.keyboard.press(digit);
        const at = await pixelOf(page, name);
        await draw(page, at, at);
        assert.deepEqual(await labelOf(page, name), [id, -1], name);
    }
    // Instances: chairs get a number each by unique ids.
    await page.keyboard.press("t");
    await page.keyboard.press("u");
    const [a, b] = [await pixelOf(page, "chair_1"), await pixelOf(page, "chair_2")];
    await page.keyboard.press("l");
    await draw(page, a, b);
    const instances = [(await labelOf(page, "chair_1"))[1], (await labelOf(page, "chair_2"))[1]];
    assert.ok(instances[0] >= 1 && instances[1] >= 1 && instances[0] !== instances[1], String(instances));
    await page.keyboard.press("Control+s");
    await page.getByText("files are written").waitFor();
    for (const name of ["mesh_objects_si.hdf5", "mesh_objects_sii.hdf5", "metadata_objects.csv", "annotation_log.jsonl"]) assert.ok(existsSync(join(labels, name)), name);
    const rows = readFileSync(join(labels, "labels.csv"), "utf8");
    for (const row of [/floor.*\bfloor\b/, /wall_back.*\bwall\b/, /chair_1.*\bchair\b/, /table_1.*\btable\b/]) assert.match(rows, row);
});

test("edits are undone after the server was killed and started again", async (t) => {
    const { file } = room(t);
    const first = await serve(t, file);
    const page = await open(await browser(t), first.url);
    await lookFromFront(page);
    await page.keyboard.press("5");
    const at = await pixelOf(page, "chair_1");
    await draw(page, at, at);
    assert.equal((await labelOf(page, "chair_1"))[0], 5);
    await first.end("SIGKILL");
    await page.locator("#offline").waitFor({ state: "visible" });
    // What is done meanwhile is kept and sent later.
    await page.evaluate(() => window.annotate.edits.send({ type: "assign", pieces: [0], apply: { layer: "semantic", value: 2 } }) && null);
    await serve(t, file, first.port);
    await page.locator("#offline").waitFor({ state: "hidden" });
    await saved(page);
    assert.equal(await page.evaluate(() => window.annotate.state.pieces.semantic[0]), 2);
    for (const before of [2, 1]) {
        await page.keyboard.press("Control+z");
        await saved(page);
        assert.notEqual(await told(page), "", `undo ${before}`);
    }
    assert.equal((await labelOf(page, "chair_1"))[0], -1);
    await page.keyboard.press("Control+Shift+z");
    await saved(page);
    assert.equal((await labelOf(page, "chair_1"))[0], 5);
});

test("filters protect what is labelled, and contradict each other", async (t) => {
    const { file } = room(t);
    const page = await open(await browser(t), (await serve(t, file)).url);
    await lookFromFront(page);
    const box = (name) => page.locator(`[data-filter="${name}"]`);
    // At first they follow the layer, and what is done.
    assert.equal(await box("only_without_instance").isChecked(), true);
    await page.keyboard.press("t");
    assert.deepEqual([await box("only_without_instance").isChecked(), await box("only_without_class").isChecked()], [false, true]);
    await page.keyboard.press("e");
    assert.deepEqual([await box("only_without_class").isChecked(), await box("only_with_class").isChecked()], [false, true]);
    await page.keyboard.press("e");
    await box("only_with_class").check();
    assert.equal(await box("only_without_class").isChecked(), false);
    await box("only_without_class").check();
    assert.equal(await box("only_with_class").isChecked(), false);
    await page.locator("#stage").focus();
    await page.keyboard.press("5");
    const at = await pixelOf(page, "chair_1");
    await draw(page, at, at);
    await page.keyboard.press("7");
    await draw(page, at, at);
    assert.equal((await labelOf(page, "chair_1"))[0], 5, "the filter keeps what has a class");
    await box("only_without_class").uncheck();
    await draw(page, at, at);
    assert.equal((await labelOf(page, "chair_1"))[0], 7);
});
