// Tools, camera, lists and search: each does what its name says.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { browser, drag, labelOf, lookFromFront, open, pictureAt, pixelOf, room, saved, select, selected, serve, shown } from "./room.mjs";

const openRoom = async (t) => {
    const page = await open(await browser(t), (await serve(t, room(t).file)).url);
    await lookFromFront(page);
    return page;
};
const give = (page, name, semantic) =>
    page.evaluate(async ([wanted, value]) => {
        const { edits, state } = window.annotate;
        await edits.send({ type: "assign", pieces: [state.pieces.names.indexOf(wanted)], apply: { layer: "semantic", value } });
    }, [name, semantic]);

test("a tool draws by a plain drag, and Select moves the camera again", async (t) => {
    const page = await openRoom(t);
    const tool = (name) => page.locator("#tools").getByRole("button", { name }).click();
    await page.locator('[data-class="5"]').first().click();
    await tool("Rectangle");
    const [x, y] = await pixelOf(page, "chair_1");
    await drag(page, [x, y], [x + 5, y + 5]);
    await saved(page);
    assert.equal((await labelOf(page, "chair_1"))[0], 5);
    await tool("Select");
    const where = () => page.evaluate(() => window.annotate.stage.camera.position.toArray());
    const before = await where();
    await drag(page, [x, y], [x + 40, y]);
    assert.notDeepEqual(await where(), before);
});

test("the eyedropper takes a label by one click, and gives way to the tool before", async (t) => {
    const page = await openRoom(t);
    await give(page, "table_1", 7);
    await page.keyboard.press("t");
    await page.keyboard.press("p");
    await page.keyboard.press("i");
    await page.mouse.click(...(await pixelOf(page, "table_1")));
    await page.waitForFunction(() => window.annotate.state.currentClass === 7);
    assert.equal(await page.evaluate(() => window.annotate.state.tool), "pen");
    await page.keyboard.press("i");
    await page.mouse.click(...(await pixelOf(page, "chair_1")));
    await page.getByText("chair_1 has no class to take").waitFor();
});

test("a stroke that filters leave nothing of says which", async (t) => {
    const page = await openRoom(t);
    await give(page, "chair_1", 5);
    for (const key of ["p", "7"]) await page.keyboard.press(key);
    const [x, y] = await pixelOf(page, "chair_1");
    await drag(page, [x, y], [x + 2, y]);
    await page.getByText("Nothing was labelled: chair_1 left out.").waitFor();
    await page.getByText("“without class”").waitFor();
});

test("the wheel ends near the scene, and one key shows all of it", async (t) => {
    const page = await openRoom(t);
    await page.locator("#stage").hover();
    const far = () => page.evaluate(() => window.annotate.stage.camera.position.length());
    for (let i = 0; i < 60; i++) await page.mouse.wheel(0, 600);
    await shown(page);
    assert.ok((await far()) < 25, `${await far()} m`);
    for (const key of ["Home", "End"]) {
        await page.keyboard.press(key);
        await shown(page);
        const seen = await page.evaluate(() => {
            const { stage } = window.annotate;
            const { clientWidth, clientHeight } = stage.element;
            return [stage.seenIn([0, 0, clientWidth, clientHeight]).size, stage.seenIn([0, 0, clientWidth, 3]).size];
        });
        assert.ok(seen[0] >= 5 && seen[1] === 0, `${key}: ${seen}`);
    }
    assert.ok(await page.evaluate(() => window.annotate.stage.camera.position.z > 5));
});

test("looking at a piece ends where it is seen", async (t) => {
    const page = await openRoom(t);
    // From just above the floor.
    await page.evaluate(() => window.annotate.stage.goTo({ position: [0, -2.5, 0.1], orientation: [1, 0, 0, 0, 0, -1, 0, 1, 0], fov_y_deg: 50 }, { instant: true }));
    for (const name of ["floor", "chair_2", "wall_back", "table_1"]) {
        await select(page, name);
        await page.keyboard.press("o");
        await page.waitForFunction(() => {
            const { stage, state } = window.annotate;
            const [piece] = state.selection;
            const middle = [0, 1, 2].map((axis) => (state.pieces.mins[piece][axis] + state.pieces.maxs[piece][axis]) / 2);
            return Math.hypot(...stage.controls.lookAt.toArray().map((v, axis) => v - middle[axis])) < 1e-3;
        });
        await shown(page);
        const share = await page.evaluate(() => {
            const { stage, state } = window.annotate;
            const { clientWidth: w, clientHeight: h } = stage.element;
            const places = Array.from({ length: 400 }, (_, i) => [((i % 20) + 0.5) * (w / 20), (Math.floor(i / 20) + 0.5) * (h / 20)]);
            return places.filter(([x, y]) => state.selection.has(stage.seenAt(x, y).piece)).length / places.length;
        });
        assert.ok(share > 0.04, `${name}: ${share}`);
        assert.ok(await page.evaluate(() => window.annotate.stage.camera.position.z > 0), `${name} from below the floor`);
    }
});

test("what is cut away is neither shown nor labelled", async (t) => {
    const page = await openRoom(t);
    const at = await pixelOf(page, "lamps");
    const [x, y] = await page.evaluate(([left, top]) => {
        const box = window.annotate.stage.element.getBoundingClientRect();
        return [left - box.left, top - box.top];
    }, at);
    const seen = () => page.evaluate(([left, top]) => window.annotate.stage.seenAt(left, top).piece, [x, y]);
    const lamps = await seen();
    // The room is 2.5 m high, and the lamps begin at 0.5 m.
    for (let i = 0; i < 9; i++) await page.keyboard.press("PageDown");
    await shown(page);
    assert.notEqual(await seen(), lamps);
    for (const key of ["p", "3", "5"]) await page.keyboard.press(key);
    await drag(page, at, [at[0] + 2, at[1]]);
    await saved(page);
    assert.equal((await labelOf(page, "lamps"))[0], -1);
    await page.keyboard.press("Shift+h");
    await shown(page);
    assert.equal(await seen(), lamps);
});

test("the clip box is put around the selection, and its sides are moved", async (t) => {
    const page = await openRoom(t);
    const seen = () => page.evaluate(() => {
        const { stage, state } = window.annotate;
        return [...stage.seenIn([0, 0, stage.element.clientWidth, stage.element.clientHeight])].map((piece) => state.name(piece)).sort();
    });
    await select(page, "chair_1");
    await page.keyboard.press("Shift+B");
    await shown(page);
    assert.deepEqual(await seen(), ["chair_1", "floor"]);
    // The side that faces the camera goes through the chair, and then the top comes down.
    for (let i = 0; i < 2; i++) await page.keyboard.press("Shift+PageDown");
    for (let i = 0; i < 4; i++) await page.keyboard.press("PageDown");
    const clip = await page.evaluate(() => window.annotate.stage.clip);
    assert.deepEqual([clip.min[1].toFixed(2), clip.max[2].toFixed(2)], ["0.20", "0.20"]);
    await page.keyboard.press("Shift+H");
    await shown(page);
    assert.equal((await seen()).length, 6);
});

test("a room is shown alone", async (t) => {
    const flat = (name, x, y) => /** @type {[string, number[][][]]} */ ([`floor_${name}`, [[[x, y, -0.1], [x + 2, y + 2, 0]]]]);
    const { file } = room(t, [flat("hall", 10, 0), flat("kitchen", 12, 0), ["stove", [[[13, 1, 0], [13.5, 1.5, 0.9]]]]]);
    const page = await open(await browser(t), (await serve(t, file)).url);
    assert.deepEqual(await page.locator("#rooms option").allTextContents(), ["All rooms", "room floor", "hall", "kitchen"]);
    await page.selectOption("#rooms", { label: "kitchen" });
    await shown(page);
    const seen = await page.evaluate(() => {
        const { stage, state } = window.annotate;
        return [...stage.seenIn([0, 0, stage.element.clientWidth, stage.element.clientHeight])].map((piece) => state.name(piece)).sort();
    });
    assert.deepEqual(seen.filter((name) => name !== "floor_hall"), ["floor_kitchen", "stove"]);
    // What asks the server about the view works there too: looking, the eyedropper, and strokes.
    await select(page, "stove");
    const flown = page.waitForResponse("**/api/annotate/viewpoint");
    await page.locator("#stage").focus();
    await page.keyboard.press("o");
    assert.equal((await flown).status(), 200);
    await shown(page);
    await page.evaluate(() => window.annotate.state.setClass(5));
    await page.keyboard.press("b");
    const edited = page.waitForResponse("**/api/annotate/edit");
    const [x, y] = await pixelOf(page, "stove");
    await drag(page, [x - 3, y - 3], [x + 3, y + 3]);
    assert.equal((await edited).status(), 200);
    await page.waitForFunction(() => window.annotate.state.pieces.semantic[window.annotate.state.pieces.names.indexOf("stove")] === 5);
    await page.keyboard.press("Shift+H");
    assert.equal(await page.locator("#rooms").inputValue(), "-1");
});

test("a planned camera of another room shows all rooms, and has a point near by to turn about", async (t) => {
    const flat = (name, x, y) => /** @type {[string, number[][][]]} */ ([`floor_${name}`, [[[x, y, -0.1], [x + 2, y + 2, 0]]]]);
    const { file } = room(t, [flat("hall", 10, 0), flat("kitchen", 12, 0)]);
    const context = await (await browser(t)).newContext({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce" });
    const frame = { frame: 0, position: [0, -3, 1], orientation: [1, 0, 0, 0, 0, -1, 0, 1, 0], fov_y_deg: 50, aspect: 1.2, photograph: false };
    await context.route("**/api/annotate/scene", async (route) => {
        const scene = await (await route.fetch()).json();
        await route.fulfill({ json: { ...scene, cameras: [{ name: "cam", frames: [frame] }] } });
    });
    const page = await open(context, (await serve(t, file)).url);
    await page.selectOption("#rooms", { label: "kitchen" });
    await page.locator("#stage").focus();
    await page.keyboard.press("]");
    await shown(page);
    assert.equal(await page.locator("#rooms").inputValue(), "-1");
    const ahead = await page.evaluate(() => window.annotate.stage.camera.position.distanceTo(window.annotate.stage.controls.lookAt));
    assert.ok(Math.abs(ahead - 2) < 1e-6, `${ahead}`);
});

test("isolating a selection keeps what was hidden before", async (t) => {
    const page = await openRoom(t);
    const hidden = () => page.evaluate(() => [...window.annotate.state.hidden].map((piece) => window.annotate.state.name(piece)));
    await select(page, "floor");
    await page.locator("#stage").focus();
    await page.keyboard.press("h");
    const before = await hidden();
    assert.deepEqual(before, ["floor"]);
    await select(page, "chair_1");
    await page.keyboard.press("v");
    assert.ok((await hidden()).length > 1);
    await page.keyboard.press("v");
    assert.deepEqual(await hidden(), before);
});

test("a click selects all of the class where that is asked for", async (t) => {
    const page = await openRoom(t);
    await page.evaluate(async () => {
        const { names } = window.annotate.state.pieces;
        const pieces = [...names.keys()].filter((piece) => names[piece].includes("chair"));
        await window.annotate.edits.send({ type: "assign", pieces, apply: { layer: "semantic", value: 5 } });
    });
    await page.locator("#stage").focus();
    await page.keyboard.press("Alt+3");
    await lookFromFront(page);
    await page.mouse.click(...(await pixelOf(page, "chair_1")));
    const chairs = await selected(page);
    assert.ok(chairs.length > 1 && chairs.every((name) => name.includes("chair")), `${chairs}`);
    await page.keyboard.press("Alt+1");
    await page.mouse.click(...(await pixelOf(page, "chair_1")));
    assert.equal((await selected(page)).length, 1);
});

test("a reload keeps the camera, the layer and the class", async (t) => {
    const page = await openRoom(t);
    await page.locator("#stage").focus();
    await page.evaluate(() => window.annotate.state.setClass(5));
    await page.keyboard.press("ArrowLeft");
    const what = () => page.evaluate(() => {
        const { state, stage } = window.annotate;
        return [state.layer, state.currentClass, stage.camera.position.toArray().map((v) => v.toFixed(6)), stage.controls.lookAt.toArray().map((v) => v.toFixed(6))];
    });
    const before = await what();
    assert.deepEqual(before.slice(0, 2), ["semantic", 5]);
    await page.waitForTimeout(500);
    await page.reload();
    await shown(page);
    assert.deepEqual(await what(), before);
});

test("Enter in the search of pieces goes to the first one found", async (t) => {
    const page = await openRoom(t);
    await select(page, "wall");
    await page.locator("#stage").focus();
    await page.keyboard.press("/");
    await page.keyboard.type("chair");
    await page.keyboard.press("Enter");
    const [first] = await selected(page);
    assert.match(first, /chair/u);
    assert.equal(await page.evaluate(() => document.activeElement?.getAttribute("role")), "listbox");
});

test("things show as they look, under the picture of a planned frame where it shows them", async (t) => {
    const context = await (await browser(t)).newContext({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce" });
    const frame = { frame: 0, position: [0, -5, 2], orientation: [1, 0, 0, 0, 0.1, -0.995, 0, 0.995, 0.1], fov_y_deg: 50, aspect: 1.2, photograph: true };
    await context.route("**/api/annotate/scene", async (route) => {
        const scene = await (await route.fetch()).json();
        await route.fulfill({ json: { ...scene, cameras: [{ name: "cam", frames: [frame] }] } });
    });
    const green = '<svg xmlns="http://www.w3.org/2000/svg" width="12" height="10"><rect width="12" height="10" fill="#00c000"/></svg>';
    await context.route("**/api/annotate/photograph/cam/0", (route) => route.fulfill({ contentType: "image/svg+xml", body: green }));
    const page = await open(context, (await serve(t, room(t).file)).url);
    await lookFromFront(page);
    const front = await pixelOf(page, "chair_1");
    await page.keyboard.press("Shift+R");
    await page.waitForFunction(() => window.annotate.stage.photograph.texture !== null);
    const [[r, g, b]] = await pictureAt(page, front, 2);
    assert.ok(g > 150 && r < 60 && b < 60, `${[r, g, b]}`);
    assert.equal(await page.locator('[data-command="real-look"]').getAttribute("aria-pressed"), "true");
    // From behind, what the picture does not show is as its material is: grey.
    await page.evaluate(() => window.annotate.stage.goTo({ position: [-1.5, 2.5, 0.6], orientation: [-1, 0, 0, 0, 0, 1, 0, 1, 0], fov_y_deg: 40 }, { instant: true }));
    await shown(page);
    const box = await page.locator("#stage").boundingBox();
    const behind = [Math.round(box.x + box.width / 2), Math.round(box.y + box.height / 2)];
    const [back] = await pictureAt(page, behind, 2);
    assert.ok(Math.max(...back) - Math.min(...back) < 12 && back[0] > 60, `${back}`);
    await page.keyboard.press("Shift+R");
    assert.notDeepEqual((await pictureAt(page, behind, 2))[0], back);
});

test("arrow keys turn the camera, about the scene and on the spot", async (t) => {
    const page = await openRoom(t);
    await page.locator("#stage").focus();
    const pose = () => page.evaluate(() => [window.annotate.stage.camera.position.toArray(), window.annotate.stage.camera.quaternion.toArray()]);
    const before = await pose();
    await page.keyboard.press("ArrowLeft");
    const turned = await pose();
    assert.notDeepEqual(turned[0], before[0]);
    await page.keyboard.press("Shift+ArrowUp");
    const tilted = await pose();
    assert.deepEqual([tilted[0], tilted[1].join() === turned[1].join()], [turned[0], false]);
});

test("names are found without capitals and accents, also those of one's own classes", async (t) => {
    const { folder, file } = room(t);
    const list = join(folder, "classes.csv");
    writeFileSync(list, "semantic_id,semantic_name,semantic_color_r,semantic_color_g,semantic_color_b\n1,Tür,255,0,0\n2,Fußboden,0,255,0\n");
    const page = await open(await browser(t), (await serve(t, file, 0, "annotate", ["--classes", list])).url);
    const shownClasses = () => page.locator("#panel-classes .classes:not(.recent) button:visible .name").allInnerTexts();
    for (const [text, found] of [["tur", "Tür"], ["TÜR", "Tür"], ["fussb", "Fußboden"]]) {
        await page.getByLabel("Search classes").fill(text);
        assert.deepEqual(await shownClasses(), [found], text);
    }
});

test("the name under the pointer follows edits", async (t) => {
    const page = await openRoom(t);
    await page.mouse.move(...(await pixelOf(page, "chair_1")));
    await page.locator("#hover", { hasText: "chair_1 · no class" }).waitFor();
    await give(page, "chair_1", 5);
    await page.locator("#hover", { hasText: "chair_1 · chair" }).waitFor();
});

test("things with a class and no instance are listed, and the dot goes through them", async (t) => {
    const page = await openRoom(t);
    for (const name of ["chair_1", "chair_2"]) await give(page, name, 5);
    await page.waitForFunction(() => window.annotate.act.missing.instance.length === 2);
    await page.getByRole("tab", { name: "To do" }).click();
    await page.getByLabel("What is missing").selectOption("instance");
    assert.equal(await page.locator("#panel-unlabelled .piece").count(), 2);
    await page.locator("#stage").focus();
    await page.keyboard.press(".");
    const [first] = await selected(page);
    assert.match(first, /chair/);
});

test("one key makes a thing of the selection, in one step, and goes on to the next", async (t) => {
    const page = await openRoom(t);
    await page.waitForFunction(() => window.annotate.act.unlabelled.length > 0);
    await select(page, "chair_1");
    for (const key of ["5", "Shift+Enter"]) await page.keyboard.press(key);
    await saved(page);
    assert.deepEqual(await labelOf(page, "chair_1"), [5, 1]);
    const [next] = await selected(page);
    assert.ok(next && next !== "chair_1", next);
    await page.keyboard.press("Shift+Enter");
    await saved(page);
    assert.deepEqual(await labelOf(page, next), [5, 2]);
    await page.keyboard.press("Control+z");
    await saved(page);
    assert.deepEqual(await labelOf(page, next), [-1, -1]);
    assert.deepEqual(await labelOf(page, "chair_1"), [5, 1]);
});

test("the palette closes by one Escape, and finds classes", async (t) => {
    const page = await openRoom(t);
    await select(page, "table_1");
    const dialog = page.getByRole("dialog", { name: "Commands" });
    await page.keyboard.press("Control+k");
    await page.keyboard.type("wire");
    await page.keyboard.press("Escape");
    assert.equal(await dialog.isVisible(), false);
    await page.keyboard.press("Control+k");
    await page.keyboard.type("class table");
    await page.keyboard.press("Enter");
    await saved(page);
    assert.equal((await labelOf(page, "table_1"))[0], 7);
});

test("buttons stay where they are, and each group is one tab stop", async (t) => {
    const page = await openRoom(t);
    const places = () => page.evaluate(() => [...document.querySelectorAll("#current button, #top button, #tabs button, #tools button")].map((one) => Object.values(one.getBoundingClientRect().toJSON()).map(Math.round).join()));
    const before = await places();
    await select(page, "chair_1");
    assert.deepEqual(await places(), before, "with a selection");
    await page.keyboard.press("5");
    await page.keyboard.press("Enter");
    await saved(page);
    assert.deepEqual(await places(), before, "after an edit");
    const stops = await page.evaluate(() => [...document.querySelectorAll("button, input, select, [tabindex]")].filter((one) => one.tabIndex === 0 && one.checkVisibility() && !one.disabled).length);
    assert.ok(stops <= 9, `${stops} tab stops`);
});
