// Splitting, suggestions, two tabs, keys alone.

import assert from "node:assert/strict";
import { test } from "node:test";
import { browser, draw, labelOf, lookFromFront, open, pixelOf, room, saved, select, selected, serve, shown } from "./room.mjs";

test("a part of two components is split, and undo makes it whole", async (t) => {
    const { file } = room(t);
    const page = await open(await browser(t), (await serve(t, file)).url);
    await lookFromFront(page);
    const count = () => page.evaluate(() => window.annotate.state.count);
    const before = await count();
    await select(page, "lamps");
    await page.keyboard.press("k");
    await saved(page);
    assert.equal(await count(), before + 1);
    assert.deepEqual(await selected(page), ["lamps", "lamps~2"], "all that it was split into");
    // The view knows the new piece at once.
    await lookFromFront(page);
    await pixelOf(page, "lamps~2");
    await page.keyboard.press("Control+z");
    await saved(page);
    assert.equal(await count(), before);
});

test("the pieces of a split have the label of what was split, and what is suggested for it", async (t) => {
    const { file } = room(t);
    const page = await open(await browser(t), (await serve(t, file)).url);
    await select(page, "lamps");
    await page.evaluate(async () => {
        const pieces = [...window.annotate.state.selection];
        for (const apply of [{ layer: "semantic", value: 35 }, { layer: "instance", new: true }]) await window.annotate.edits.send({ type: "assign", pieces, apply });
    });
    await page.keyboard.press("k");
    await saved(page);
    assert.deepEqual(await labelOf(page, "lamps~2"), [35, 1]);
    assert.deepEqual(await labelOf(page, "lamps"), [35, 1]);
    const [whole, piece] = await page.evaluate(() => ["lamps", "lamps~2"].map((name) => window.annotate.state.pieces.suggestions[window.annotate.state.pieces.names.indexOf(name)]));
    assert.deepEqual(piece, whole);
});

test("painted faces become a piece", async (t) => {
    const { file } = room(t);
    const page = await open(await browser(t), (await serve(t, file)).url);
    await lookFromFront(page);
    const before = await page.evaluate(() => window.annotate.state.count);
    await select(page, "table_1");
    await page.keyboard.press("m");
    const at = await pixelOf(page, "table_1");
    await page.mouse.move(...at);
    await page.mouse.down();
    await page.mouse.move(at[0] + 3, at[1]);
    await page.mouse.up();
    await page.waitForFunction(() => window.annotate.state.painting.faces.size > 0);
    await page.keyboard.press("Enter");
    await saved(page);
    assert.equal(await page.evaluate(() => window.annotate.state.count), before + 1);
});

test("suggestions are confirmed in bulk, as one step", async (t) => {
    const { file } = room(t);
    const page = await open(await browser(t), (await serve(t, file)).url);
    await page.getByRole("tab", { name: "Suggested" }).click();
    await page.locator('input[type="range"]').fill("0.3");
    await page.locator("#confirm-all").click();
    await saved(page);
    assert.equal((await labelOf(page, "chair_1"))[0], 5);
    assert.equal((await labelOf(page, "floor"))[0], 2);
    await page.keyboard.press("Control+z");
    await saved(page);
    assert.equal((await labelOf(page, "chair_1"))[0], -1);
    assert.equal((await labelOf(page, "floor"))[0], -1);
});

test("two tabs see each other's edits, and lose none", async (t) => {
    const { file } = room(t);
    const { url } = await serve(t, file);
    const one = await browser(t);
    const [a, b] = [await open(one, url), await open(one, url)];
    const assign = (page, piece, value) => page.evaluate(([at, id]) => window.annotate.edits.send({ type: "assign", pieces: [at], apply: { layer: "semantic", value: id } }), [piece, value]);
    await Promise.all([assign(a, 0, 2), assign(b, 1, 1), assign(a, 2, 5), assign(b, 3, 5)]);
    for (const page of [a, b]) await page.waitForFunction(() => [2, 1, 5, 5].every((id, piece) => window.annotate.state.pieces.semantic[piece] === id));
});

test("two tabs give their things instances of their own", async (t) => {
    const { file } = room(t);
    const { url } = await serve(t, file);
    const one = await browser(t);
    const tabs = [await open(one, url), await open(one, url)];
    const instances = [];
    for (const [page, names] of [[tabs[0], ["chair_1", "chair_2"]], [tabs[1], ["table_1"]]]) {
        await page.bringToFront();
        await lookFromFront(page);
        for (const name of names) {
            const [x, y] = await pixelOf(page, name);
            await draw(page, [x, y], [x + 2, y + 2]);
            instances.push((await labelOf(page, name))[1]);
        }
    }
    assert.deepEqual(instances, [1, 1, 2], "a tab keeps its instance until it is asked for a new one");
    await tabs[0].bringToFront();
    await tabs[0].keyboard.press(" ");
    await tabs[0].waitForFunction(() => window.annotate.state.pieces.instance.includes(2));
    // Both are on their way before the first has its number.
    const pieces = await tabs[0].evaluate(async () => {
        const { act, state } = window.annotate;
        const pieces = ["floor", "wall_back"].map((name) => state.pieces.names.indexOf(name));
        await Promise.all(pieces.map((piece) => act.give({ type: "assign", pieces: [piece] })));
        return pieces.map((piece) => state.pieces.instance[piece]);
    });
    assert.deepEqual(pieces, [3, 3]);
});

test("a room is labelled by keys alone, and the help lists them", async (t) => {
    const { file } = room(t);
    const page = await open(await browser(t), (await serve(t, file)).url);
    await page.locator("#stage").focus();
    await page.keyboard.press("?");
    await page.getByRole("dialog", { name: "Keys" }).waitFor();
    const listed = await page.locator("#help .keys section > div").count();
    assert.ok(listed > 40, `${listed} keys`);
    await page.keyboard.press("Escape");
    await page.waitForFunction(() => window.annotate.act.unlabelled.length > 0);
    const total = await page.evaluate(() => window.annotate.state.count);
    for (let i = 0; i < total; i++) {
        await page.keyboard.press(".");
        await page.keyboard.press("4");
        await page.keyboard.press("0");
        await page.keyboard.press("Enter");
        await saved(page);
    }
    assert.deepEqual(await page.evaluate(() => [...new Set(window.annotate.state.pieces.semantic)]), [40]);
});

test("what lies before the picture is neither seen nor picked", async (t) => {
    const { file } = room(t);
    const page = await open(await browser(t), (await serve(t, file)).url);
    // Within a chair, three centimetres before its back.
    await page.evaluate(() => window.annotate.stage.goTo({ position: [-1.5, 0.57, 0.45], orientation: [1, 0, 0, 0, 0, -1, 0, 1, 0], fov_y_deg: 50 }, { instant: true }));
    await shown(page);
    const [seen, picked, touched] = await page.evaluate(async () => {
        const { stage, state } = window.annotate;
        const [x, y] = [stage.element.clientWidth / 2, stage.element.clientHeight / 2];
        const ask = async (what, more) => (await fetch(`/api/annotate/${what}`, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify({ camera: stage.cameraJson(), ...more }) })).json();
        const { piece } = await ask("pick", { pixel: [x, y] });
        const { pieces } = await ask("select", { shape: { rectangle: [x - 2, y - 2, x + 2, y + 2] } });
        return [[stage.seenAt(x, y).piece], [piece], pieces].map((all) => all.map((one) => state.name(one)));
    });
    assert.deepEqual([seen, picked, touched], [["wall_back"], ["wall_back"], ["wall_back"]]);
});

test("same names and same geometry are selected together", async (t) => {
    const { file } = room(t);
    const page = await open(await browser(t), (await serve(t, file)).url);
    await select(page, "chair_1");
    await page.keyboard.press("n");
    assert.deepEqual(await selected(page), ["chair_1", "chair_2"]);
    await select(page, "chair_2");
    await page.keyboard.press("j");
    assert.ok((await selected(page)).includes("chair_2"));
});

test("large faces come first, the rest follows, and what was split meanwhile stays so", async (t) => {
    const context = await (await browser(t)).newContext({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce" });
    let go = () => {};
    const wait = new Promise((resolve) => (go = () => resolve(null)));
    await context.route("**/api/annotate/geometry", async (route) => {
        const response = await route.fetch();
        await wait;
        await route.fulfill({ response });
    });
    // Many small boxes far away, in one part.
    const crowd = Array.from({ length: 4000 }, (_, i) => [[20 + (i % 60) * 0.2, 20 + Math.floor(i / 60) * 0.2, 0], [20.1 + (i % 60) * 0.2, 20.1 + Math.floor(i / 60) * 0.2, 0.1]]);
    const page = await open(context, (await serve(t, room(t, [["crowd", crowd]]).file)).url);
    const faces = () => page.evaluate(() => [window.annotate.stage.mesh.geometry.faces, window.annotate.state.scene.faces]);
    const [few, all] = await faces();
    assert.ok(few < all && (await page.locator("#rest").isVisible()), `${few} of ${all}`);
    await select(page, "lamps");
    await page.keyboard.press("k");
    await saved(page);
    go();
    await page.waitForFunction(() => window.annotate.stage.mesh.geometry.faces === window.annotate.state.scene.faces);
    await shown(page);
    assert.equal(await page.locator("#rest").isVisible(), false);
    await lookFromFront(page);
    await pixelOf(page, "lamps~2");
});
