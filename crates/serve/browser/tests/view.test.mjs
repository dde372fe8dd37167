// The page that shows a dataset, in a real browser.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { browser, dataset, enlarge, serve } from "./room.mjs";

describe("view", () => {
    let origin, page;
    const problems = [];
    const endings = [];

    before(async () => {
        const t = { after: (ending) => endings.push(ending) };
        const path = dataset(t);
        enlarge(path);
        const { url } = await serve(t, path, 0, "view");
        origin = new URL(url).origin;
        page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
        page.on("pageerror", (error) => problems.push(error.message));
    });

    after(async () => {
        for (const ending of endings.reverse()) await ending();
    });

    /** Opens the page anew at an address's hash, and waits until its picture is there. */
    async function open(hash) {
        await page.goto("about:blank");
        await page.goto(`${origin}/view/#${hash}`);
        await page.waitForSelector("body[data-ready=true]");
        await painted();
    }

    const painted = () => page.waitForFunction(() => document.querySelector("#stage").dataset.frame !== "" && document.querySelector("#busy").hidden);
    /** Waits until the address says this of a word; `null` for nothing. */
    const addressSays = (word, wanted) => page.waitForFunction(([word, wanted]) => new URLSearchParams(location.hash.slice(1)).get(word) === wanted, [word, wanted], { timeout: 15_000 });
    const json = (path) => fetch(`${origin}/api/view/${path}`).then((response) => response.json());

    /** The stored numbers of a layer, as the server's file has them. */
    async function stored(scene, camera, frame, layer) {
        const response = await fetch(`${origin}/api/view/layer/${scene}/${camera}/${frame}/${layer}`);
        const [height, width, channels] = response.headers.get("x-enfilade-shape").split(",").map(Number);
        const dtype = response.headers.get("x-enfilade-dtype");
        const view = new DataView(await response.arrayBuffer());
        const half = (bits) => (bits & 0x8000 ? -1 : 1) * ((bits >> 10) & 31 ? ((bits >> 10) & 31) === 31 ? (bits & 1023 ? NaN : Infinity) : 2 ** (((bits >> 10) & 31) - 25) * (1024 + (bits & 1023)) : 2 ** -24 * (bits & 1023));
        const number = (i) => ({ float16: () => half(view.getUint16(2 * i, true)), float32: () => view.getFloat32(4 * i, true), int16: () => view.getInt16(2 * i, true), uint8: () => view.getUint8(i) })[dtype]();
        return { width, height, at: (x, y) => Array.from({ length: channels }, (_, c) => number((y * width + x) * channels + c)), dtype };
    }

    /** Moves the cursor to the middle of a pixel, and returns the read-out of the first picture. */
    async function readAt(x, y, layer, size) {
        const box = await page.locator("#stage").boundingBox();
        const scale = Math.min(box.width / size.width, box.height / size.height);
        await page.mouse.move(box.x + box.width / 2 + (x + 0.5 - size.width / 2) * scale, box.y + box.height / 2 + (y + 0.5 - size.height / 2) * scale);
        const line = page.locator(`#readout [data-layer="${layer}"][data-side="0"]`);
        await line.locator(".value").waitFor();
        const text = await line.innerText();
        const [, px, py] = text.match(/^\s*(\d+),\s*(\d+)/).map(Number);
        return { x: px, y: py, values: (await line.locator(".value").innerText()).trim().split(/\s+/) };
    }

    test("every layer is shown, and the values under the cursor are those of the files", async () => {
        const { scenes, layers } = await json("dataset");
        const { cameras } = await json(`scene/${scenes[0]}`);
        const { frames } = await json(`camera/${scenes[0]}/${cameras[0]}`);
        const { frame, layers: there } = frames.find((one) => one.layers.length);
        await open(`scene=${scenes[0]}&camera=${cameras[0]}&frame=${frame}`);
        for (const { name } of there.map((at) => layers[at])) {
            await page.selectOption("#layer-0", name);
            await painted();
            const file = await stored(scenes[0], cameras[0], frame, name);
            for (const [fx, fy] of [[0.3, 0.4], [0.7, 0.8]]) {
                const read = await readAt(Math.floor(fx * file.width), Math.floor(fy * file.height), name, file);
                const expected = file.at(read.x, read.y);
                const same = (text, value) => (Number.isNaN(value) ? text === "NaN" : file.dtype === "float32" ? Math.fround(Number(text)) === value : Math.abs(Number(text) - value) <= Math.abs(value) * 2 ** -11 + 2 ** -25);
                assert.ok(expected.every((value, i) => same(read.values[i], value)), `${name} at ${read.x}, ${read.y}: read ${read.values}, stored ${expected}`);
            }
            assert.ok(await page.locator("#message").isHidden(), `${name}: ${await page.locator("#message").innerText()}`);
        }
        assert.deepEqual(problems, []);
    });

    /** Mean brightness of a part of the stage, 0 to 255, as it is on the screen. */
    async function brightness(part) {
        const box = await page.locator("#stage").boundingBox();
        const picture = await page.screenshot({ clip: { x: box.x + part.x * box.width, y: box.y + part.y * box.height, width: 40, height: 40 } });
        return page.evaluate(async (bytes) => {
            const image = await createImageBitmap(new Blob([new Uint8Array(bytes)]));
            const canvas = new OffscreenCanvas(image.width, image.height);
            const pen = canvas.getContext("2d");
            pen.drawImage(image, 0, 0);
            const { data } = pen.getImageData(0, 0, image.width, image.height);
            let sum = 0;
            for (let i = 0; i < data.length; i += 4) sum += data[i] + data[i + 1] + data[i + 2];
            return sum / (data.length / 4) / 3;
        }, [...picture]);
    }

    test("exposure is changed by keys and makes the picture brighter", async () => {
        await open("layer=color");
        await page.mouse.move(5, 5);
        const before = await brightness({ x: 0.5, y: 0.6 });
        for (let i = 0; i < 4; i++) await page.keyboard.press("e");
        await painted();
        await addressSays("stops", "2");
        assert.ok((await brightness({ x: 0.5, y: 0.6 })) > before * 1.2);
        await page.keyboard.press("q");
        await addressSays("stops", null);
    });

    test("the border of the wipe is dragged, and both sides tell their values", async () => {
        await open("mode=wipe&layer=color&other=depth_meters");
        const box = await page.locator("#stage").boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + 100);
        await page.mouse.down();
        await page.mouse.move(box.x + box.width * 0.3, box.y + 100, { steps: 4 });
        await page.mouse.up();
        await page.waitForFunction(() => Math.abs(Number(new URLSearchParams(location.hash.slice(1)).get("wipe") ?? NaN) - 0.3) < 0.01, null, { timeout: 15_000 });
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        for (const layer of ["color", "depth_meters"]) assert.match(await page.locator(`#readout [data-layer="${layer}"]`).innerText(), /\d/);
    });

    test("an instance under the cursor is marked and named, and a click keeps it", async () => {
        await open("layer=color&tab=objects");
        const first = page.locator("#panel tr[data-instance]").first();
        await first.waitFor();
        const id = await first.getAttribute("data-instance");
        await first.click();
        await page.locator("#panel h2", { hasText: `Instance ${id}` }).waitFor();
        await addressSays("instance", id);
        await page.keyboard.press("Escape");
        await addressSays("instance", null);
    });

    test("the instance of a pixel is marked while the cursor is on it, with its name and class", async () => {
        const { scenes } = await json("dataset");
        const { cameras, objects } = await json(`scene/${scenes[0]}`);
        await open("layer=color&frame=0&boxes=true");
        const ids = await stored(scenes[0], cameras[0], 0, "semantic_instance");
        const marked = [];
        for (let y = 4; y < ids.height && !marked.length; y += 9) {
            for (let x = 4; x < ids.width && !marked.length; x += 9) if (ids.at(x, y)[0] > 0 && ids.at(x + 1, y)[0] === ids.at(x, y)[0]) marked.push(x, y);
        }
        const read = await readAt(marked[0], marked[1], "color", ids);
        const instance = page.locator('#readout [data-names="semantic_instance"]');
        await instance.waitFor();
        const id = ids.at(read.x, read.y)[0];
        assert.ok((await instance.innerText()).startsWith(`${id} ${objects.names[objects.instance.indexOf(id)]}`));
        assert.match(await page.locator('#readout [data-names="semantic"]').innerText(), new RegExp(`^${objects.semantic[objects.instance.indexOf(id)]} `));
    });

    test("what was split off has its own name, and classes are those of the scene", async () => {
        await open("layer=color");
        const told = await page.evaluate(async () => {
            const { Looks } = await import("../view/looks.js");
            const { dataset, scene } = window.view.session;
            const looks = new Looks(dataset);
            const objects = { names: ["harp", "harp~2"], semantic: [7, 77], instance: [1, 2] };
            looks.enter({ ...scene, parts: ["sky", "harp"], objects, classes: [{ id: 77, name: "string", color: [1, 2, 3] }] });
            return [looks.name("render_entity_id", 2), looks.instanceName(2), looks.className(looks.classOfInstance(2)), looks.color("semantic", 77), looks.className(7)];
        });
        assert.deepEqual(told, ["harp", "harp~2", "string", [1, 2, 3], "unlabelled"]);
    });

    test("the scene is shown in 3D with its free space", async () => {
        await open("mode=space&frame=0");
        await page.locator("#space canvas").waitFor();
        const cubes = page.waitForResponse((response) => response.url().endsWith("/space"));
        await page.locator('#space [data-part="free"]').check();
        assert.equal((await cubes).status(), 200);
        assert.deepEqual(problems, []);
    });

    test("surfaces are those of the scene that is shown, also when they come late", async () => {
        const faces = () => page.evaluate(() => window.view.space?.stage?.mesh?.geometry.faces ?? 0);
        const go = async (scene) => {
            await page.evaluate((scene) => window.view.session.store.set({ scene, camera: "" }), scene);
            await page.waitForFunction((scene) => window.view.space?.shown.scene === scene, scene);
        };
        await open("mode=space&scene=home&frame=0");
        await page.waitForFunction(() => window.view.space?.stage?.mesh);
        await go("unmeshed");
        assert.equal(await faces(), 0);
        let answer = () => {};
        const held = new Promise((resolve) => (answer = resolve));
        await page.route("**/scene/home/geometry", async (route) => {
            await held;
            await route.continue();
        });
        await go("home");
        await go("unmeshed");
        const late = page.waitForResponse("**/scene/home/geometry");
        answer();
        await (await late).finished();
        await page.waitForTimeout(200);
        assert.equal(await faces(), 0);
        await page.unroute("**/scene/home/geometry");
        assert.deepEqual(problems, []);
    });

    test("a point in 3D has the colour that the server says", async () => {
        await open("mode=space&scene=home&camera=cam_00&frame=0");
        await page.locator('#space [data-part="points"]').check();
        await page.waitForFunction(() => window.view.space?.groups.points?.children.length && window.view.space.stage.settled);
        const [shown, said] = await page.evaluate(async () => {
            const { stage, groups } = window.view.space;
            const buffer = await (await fetch("../api/view/points/home/cam_00/0?most=150000")).arrayBuffer();
            const count = new DataView(buffer).getUint32(8, true);
            const colors = new Uint8Array(buffer, 16 + 12 * count);
            // Neither black nor white, about in the middle of the image.
            let at = Math.floor(count / 2);
            while (![0, 1, 2].every((c) => colors[4 * at + c] > 40 && colors[4 * at + c] < 220)) at++;
            stage.clear();
            groups.views.visible = false;
            const [points] = groups.points.children;
            // A disc of some pixels.
            points.material.size = 20;
            points.geometry.setDrawRange(at, 1);
            const place = stage.camera.position.clone().fromBufferAttribute(points.geometry.attributes.position, at).project(stage.camera);
            const { width, height } = stage.canvas;
            stage.drawPicture();
            const pixel = new Uint8Array(4);
            stage.gl.readPixels(Math.floor(((place.x + 1) / 2) * width), Math.floor(((place.y + 1) / 2) * height), 1, 1, stage.gl.RGBA, stage.gl.UNSIGNED_BYTE, pixel);
            return [[...pixel.subarray(0, 3)], [...colors.subarray(4 * at, 4 * at + 3)]];
        });
        assert.ok(shown.every((value, c) => Math.abs(value - said[c]) <= 1), `shown ${shown}, said ${said}`);
    });

    test("the panel tells of the camera that is shown, and of no other", async () => {
        const seed = async (camera) => (await json(`frame/home/${camera}/0`)).record.seed;
        const [first, second] = [await seed("cam_00"), await seed("cam_01")];
        assert.notEqual(first, second);
        const tells = (text) => page.locator("#panel dd", { hasText: text }).waitFor();
        await open("scene=home&camera=cam_00&frame=0&tab=frame");
        await tells(first);
        await page.keyboard.press("]");
        await addressSays("camera", "cam_01");
        await tells(second);
        await page.keyboard.press("[");
        await tells(first);
    });

    test("a link restores what was seen", async () => {
        await open("mode=side&layer=normal_cam&other=depth_meters&zoom=4&x=0.25&y=0.75&tone=filmic&range=depth_meters:1:3&tab=frame");
        assert.equal(await page.locator("#layer-0").inputValue(), "normal_cam");
        assert.equal(await page.locator("#layer-1").inputValue(), "depth_meters");
        assert.equal(await page.locator('#modes [data-mode="side"]').getAttribute("aria-pressed"), "true");
        assert.equal(await page.locator('#tabs [data-tab="frame"]').getAttribute("aria-selected"), "true");
        assert.match(await page.locator("#heading-1 .legend").innerText(), /1[\s\S]*3 m/);
        await page.keyboard.press("ArrowRight");
        await addressSays("frame", "1");
        for (const [word, wanted] of [["zoom", "4"], ["x", "0.25"], ["y", "0.75"], ["tone", "filmic"], ["range", "depth_meters:1:3"]]) await addressSays(word, wanted);
    });

    test("keys go from frame to frame, from layer to layer, and show the help", async () => {
        await open("layer=color&frame=0");
        const next = await page.locator('#thumbnails [role="option"]').nth(1).getAttribute("data-frame");
        await page.keyboard.press("ArrowRight");
        await page.waitForSelector(`#stage[data-frame="${next}"]`);
        await addressSays("frame", next);
        await page.keyboard.press("d");
        await addressSays("layer", "depth_meters");
        assert.equal(await page.locator("#layer-0").inputValue(), "depth_meters");
        await page.keyboard.press("3");
        await addressSays("mode", "wipe");
        await page.keyboard.press("?");
        await page.locator("dialog[open]").waitFor();
        await page.keyboard.press("Escape");
        assert.equal(await page.locator("dialog[open]").count(), 0);
    });

    test("what an address says wrongly is as at the beginning", async () => {
        await open("frame=abc&layer=nothing&mode=x&zoom=-5&wipe=9&range=depth_meters:5:1&toString=1&limit=__proto__:1:2");
        assert.ok(await page.locator("#message").isHidden());
        assert.deepEqual(problems, []);
    });

    test("a link to what is not there says so, and shows nothing else", async () => {
        for (const [hash, said] of [["scene=nowhere&mode=one", "There is no scene nowhere"], ["scene=..%2F..&camera=%00&mode=one", "There is no scene ../.."], ["scene=home&camera=cam_77", "There is no camera cam_77"]]) {
            await page.goto("about:blank");
            await page.goto(`${origin}/view/#${hash}`);
            await page.locator("#message h2", { hasText: said }).waitFor();
            assert.equal(await page.locator("#stage").getAttribute("data-frame"), "");
            await addressSays("scene", new URLSearchParams(hash).get("scene"));
        }
        await open("scene=home&camera=cam_00&frame=70");
        await page.locator(".toast", { hasText: "Frame 70 has no pictures" }).waitFor();
        assert.deepEqual(problems, []);
    });

    test("after a layer is chosen from the list, the arrow keys change the frame", async () => {
        await open("scene=home&camera=cam_00&frame=0&layer=color");
        await page.locator("#layer-0").focus();
        await page.selectOption("#layer-0", "depth_meters");
        await page.keyboard.press("ArrowRight");
        await addressSays("frame", "1");
        await addressSays("layer", "depth_meters");
    });

    /** Moves the cursor over the stage, below its middle, until it is over an instance. */
    async function hoverAnInstance() {
        const box = await page.locator("#stage").boundingBox();
        for (let i = 0; i < 60; i++) {
            await page.mouse.move(box.x + box.width * (0.3 + (i % 10) * 0.05), box.y + box.height * (0.5 + Math.floor(i / 10) * 0.07));
            await painted();
            if (await page.evaluate(() => window.view.session.hoveredInstance > 0)) return;
        }
        assert.fail("no instance under the cursor");
    }

    test("the colours that are read under the cursor are those of the picture", async () => {
        await open("scene=home&camera=cam_00&frame=0&layer=color");
        await page.waitForFunction(() => window.view.session.idsOf(0)?.step === 1);
        const before = await brightness({ x: 0.2, y: 0.2 });
        await hoverAnInstance();
        await page.waitForTimeout(100);
        assert.ok(Math.abs((await brightness({ x: 0.2, y: 0.2 })) - before) < 1);
    });

    test("a range whose ends are exchanged is refused where it was typed", async () => {
        await open("scene=home&frame=0&layer=depth_meters&range=depth_meters:1:3");
        const max = page.locator('#panel input[aria-label="Max of depth_meters"]');
        await max.fill("0.5");
        await max.press("Enter");
        await page.locator("#panel .refused", { hasText: "must be less than" }).waitFor();
        assert.equal(await max.getAttribute("aria-invalid"), "true");
        await addressSays("range", "depth_meters:1:3");
        await max.fill("4");
        await max.press("Enter");
        await addressSays("range", "depth_meters:1:4");
        assert.equal(await page.locator("#panel .refused").innerText(), "");
    });

    test("a frame is not compared with itself", async () => {
        await open("scene=home&frame=0&mode=side&layer=color&other=depth_meters");
        assert.equal(await page.locator('#layer-1 option[value="color"]').count(), 0);
        await page.selectOption("#layer-0", "depth_meters");
        await page.waitForFunction(() => window.view.store.state.other !== "depth_meters");
        assert.equal(await page.locator("#layer-1").inputValue(), "color");
        await page.locator("#frame-1").fill("1");
        await page.locator("#frame-1").press("Enter");
        await page.locator('#layer-1 option[value="depth_meters"]').waitFor({ state: "attached" });
    });

    test("the table of objects fits beside the picture", async () => {
        await open("scene=home&frame=0&layer=color&tab=objects");
        await page.locator("#panel tr[data-instance]").first().waitFor();
        assert.ok(await page.evaluate(() => [...document.querySelectorAll("#panel, #panel td.number, #panel th")].every((one) => one.scrollWidth <= one.clientWidth)));
        await page.locator("#panel tr[data-instance]").first().focus();
        await page.keyboard.press("ArrowDown");
        assert.ok(await page.evaluate(() => document.activeElement === document.querySelectorAll("#panel tr[data-instance]")[1]));
        assert.equal(await page.locator('#panel tr[tabindex="0"]').count(), 1, "the table is one tab stop");
    });

    test("back goes to what was shown before", async () => {
        await open("scene=home&camera=cam_00&frame=0&layer=color");
        await page.selectOption("#layer-0", "depth_meters");
        await addressSays("layer", "depth_meters");
        await page.click('#modes [data-mode="side"]');
        await addressSays("mode", "side");
        await page.keyboard.press("e");
        await addressSays("stops", "0.5");
        await page.goBack();
        await addressSays("mode", null);
        assert.equal(await page.locator("#layer-0").inputValue(), "depth_meters");
        await page.goBack();
        await addressSays("layer", "color");
        assert.equal(await page.locator("#layer-0").inputValue(), "color");
        await page.goForward();
        await addressSays("layer", "depth_meters");
    });

    test("the difference of two frames is that of their numbers, pixel by pixel", async () => {
        await open("scene=home&camera=cam_00&frame=0&mode=difference&layer=depth_meters&otherFrame=1&other=depth_meters");
        await page.waitForFunction(() => window.view.session.difference());
        const [first, second] = [await stored("home", "cam_00", 0, "depth_meters"), await stored("home", "cam_00", 1, "depth_meters")];
        for (const [x, y] of [[40, 50], [120, 90]]) {
            const read = await readAt(x, y, "depth_meters", first);
            const shown = Number((await page.locator("#readout [data-difference] .value").innerText()).trim().split(" ")[0]);
            assert.equal(Math.fround(shown), Math.fround(first.at(read.x, read.y)[0] - second.at(read.x, read.y)[0]));
        }
        await page.click("#flicker");
        await addressSays("flicker", "true");
        const turns = await page.evaluate(async () => {
            const seen = new Set();
            for (let i = 0; i < 30 && seen.size < 2; i++) {
                seen.add(window.view.stage.turn);
                await new Promise((resolve) => setTimeout(resolve, 100));
            }
            return seen.size;
        });
        assert.equal(turns, 2);
    });

    test("a difference begins with layers that can be compared", async () => {
        await open("scene=home&camera=cam_00&frame=0&layer=depth_meters");
        await page.keyboard.press("5");
        await page.waitForFunction(() => window.view.session.difference());
        const { layer, other, otherFrame } = await page.evaluate(() => window.view.store.state);
        assert.ok(layer === "depth_meters" && (other !== layer || otherFrame !== null), `${other} ${otherFrame}`);
        assert.ok(await page.locator("#message").isHidden());
        assert.equal(await page.locator('#layer-1 option[value="color"]').count(), 0);
    });

    test("colours by the logarithm, names and a class alone stand in the address", async () => {
        await open("scene=home&camera=cam_00&frame=0&layer=depth_meters&tab=objects");
        await page.keyboard.press("l");
        await addressSays("log", "depth_meters");
        await page.keyboard.press("Shift+B");
        await addressSays("names", "true");
        const row = page.locator("#panel tr[data-class]").first();
        const id = await row.getAttribute("data-class");
        await row.click();
        await addressSays("class", id);
        const { objects } = await json("scene/home");
        const shown = await page.locator("#panel tr[data-instance]").evaluateAll((all) => all.map((one) => Number(one.dataset.instance)));
        assert.ok(shown.every((one) => objects.semantic[objects.instance.indexOf(one)] === Number(id)), `${shown} of ${id}`);
        await page.keyboard.press("Escape");
        await addressSays("class", null);
        assert.deepEqual(problems, []);
    });

    test("what is shown is saved as a picture", async () => {
        await open("scene=home&camera=cam_00&frame=0&layer=color");
        for (const [mode, name] of [["one", "home_cam_00_0000_color.png"], ["space", "home_cam_00_0000_3d.png"]]) {
            await page.click(`#modes [data-mode="${mode}"]`);
            if (mode === "space") await page.waitForFunction(() => window.view.space?.stage?.settled && window.view.space.stage.mesh);
            const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
            assert.equal(download.suggestedFilename(), name);
            const bytes = readFileSync(await download.path());
            assert.equal(bytes.toString("latin1", 1, 4), "PNG");
            assert.ok(bytes.length > 5000, `${bytes.length} bytes: nothing is in it`);
        }
    });

    test("in 3D what is under the cursor is named, and the camera is in the address", async () => {
        await open("scene=home&camera=cam_00&mode=space&frame=0");
        await page.waitForFunction(() => window.view.space?.stage?.mesh && window.view.space.stage.settled);
        const box = await page.locator("#space").boundingBox();
        const [x, y] = [box.x + box.width / 2, box.y + box.height * 0.7];
        await page.mouse.move(x, y);
        await page.waitForFunction(() => document.querySelector(".space-label").textContent !== "");
        assert.equal(new URLSearchParams(new URL(page.url()).hash.slice(1)).get("view"), null);
        await page.mouse.down();
        await page.mouse.move(x - 120, y, { steps: 4 });
        await page.mouse.up();
        await page.waitForFunction(() => {
            const said = (new URLSearchParams(location.hash.slice(1)).get("view") ?? "").split(",").map(Number);
            return window.view.space.stage.camera.position.toArray().every((value, i) => Math.abs(value - said[i]) < 1e-3);
        });
        const place = () => page.evaluate(() => [...window.view.space.stage.camera.position.toArray(), ...window.view.space.stage.controls.lookAt.toArray()]);
        const before = await place();
        await page.reload();
        await page.waitForFunction(() => window.view?.space?.stage?.mesh);
        const after = await place();
        assert.ok(before.every((value, i) => Math.abs(value - after[i]) < 2e-3), `${before} ${after}`);
    });

    test("after the view from above, orbiting turns about the scene", async () => {
        await open("scene=home&camera=cam_00&mode=space&frame=0");
        await page.waitForFunction(() => window.view.space?.stage?.mesh);
        const target = await page.evaluate(() => {
            const { space } = window.view;
            space.fromAbove();
            const { min, max } = space.stage.mesh.geometry;
            return space.stage.controls.lookAt.toArray().map((value, axis) => (value - min[axis]) / (max[axis] - min[axis]));
        });
        assert.ok(target.every((share) => Math.abs(share - 0.5) < 0.01), `${target}`);
        await page.locator("#space summary").click();
        assert.ok(await page.locator('#space [data-part="boxes"]').isHidden(), "the panel folds");
    });

    test("every window has room for what is shown", async () => {
        for (const [width, height] of [[320, 640], [390, 844], [640, 360], [1024, 768], [1280, 720], [3840, 2160]]) {
            await page.setViewportSize({ width, height });
            for (const mode of ["gallery", "one", "side", "difference"]) {
                await page.evaluate((mode) => window.view.store.set({ mode }), mode);
                const [wide, picture] = await page.evaluate(() => {
                    const stage = document.querySelector("#stage"), gallery = document.querySelector("#gallery-frames");
                    const shown = stage.checkVisibility() ? stage : gallery;
                    const right = [...document.querySelectorAll(".bar > *, #gallery-bar > *, .heading > *")].filter((one) => one.checkVisibility() && !one.closest(".segments")).map((one) => one.getBoundingClientRect().right);
                    return [Math.max(document.documentElement.scrollWidth, ...right) - innerWidth, shown.clientHeight / innerHeight];
                });
                assert.ok(wide <= 1, `${mode} in ${width} × ${height} is wider by ${wide}`);
                assert.ok(picture > 0.35, `${mode} in ${width} × ${height}: the picture has ${picture} of the height`);
            }
        }
        await page.setViewportSize({ width: 1280, height: 720 });
        assert.deepEqual(problems, []);
    });

    const places = () => page.locator("#gallery .place").evaluateAll((all) => all.sort((a, b) => a.ariaPosInSet - b.ariaPosInSet).map((one) => one.dataset.frame));

    test("the first page shows all frames, sorted by what is asked for, and opens one", async () => {
        await page.goto("about:blank");
        await page.goto(`${origin}/view/`);
        await page.waitForSelector("#gallery .place img");
        await page.waitForFunction(() => window.view?.gallery.rows.left === 0);
        const { frames } = await json("gallery/home");
        const rendered = frames.filter((one) => one.version);
        assert.equal((await places()).length, 2 * rendered.length, "two scenes");
        await page.selectOption('#gallery-bar [data-key="within"]', "scene");
        await page.selectOption('#gallery-bar [data-key="sort"]', "noise");
        await addressSays("sort", "noise");
        const noisiest = [...rendered].sort((a, b) => b.noise - a.noise)[0];
        const shown = await places();
        const noise = (place) => frames.find((one) => `home/${one.camera}/${one.frame}` === place).noise;
        assert.ok(shown.every((place, i) => i === 0 || noise(place) <= noise(shown[i - 1])), `${shown}`);
        assert.equal(noise(shown[0]), noisiest.noise);
        await page.locator("#gallery-frames").press("Enter");
        await painted();
        const [scene, camera, frame] = shown[0].split("/");
        for (const [word, wanted] of [["scene", scene], ["camera", camera], ["frame", frame], ["sort", "noise"]]) await addressSays(word, wanted);
        await page.goBack();
        await page.locator("#gallery .place").first().waitFor();
        assert.deepEqual(await places(), shown, "back in the gallery as it was left");
    });

    test("frames are chosen by a class, those with most of it first", async () => {
        const { frames, classes } = await json("class_shares/home");
        const counts = (id) => frames.filter(({ camera, shares }) => camera === "cam_00" && shares[id] > 0);
        // A class that not every frame shows, if there is one.
        const { id } = [...classes].sort((a, b) => counts(a.id).length - counts(b.id).length).find((one) => counts(one.id).length > 0);
        await page.goto("about:blank");
        await page.goto(`${origin}/view/#scene=home&camera=cam_00&mode=gallery&within=camera`);
        await page.locator("#gallery .place").first().waitFor();
        await page.selectOption("#of-class", String(id));
        await page.waitForFunction(() => window.view.gallery.rows.left === 0 && window.view.gallery.rows.classes.size > 0);
        const wanted = counts(id).sort((a, b) => b.shares[id] - a.shares[id]).map(({ frame }) => `home/cam_00/${frame}`);
        assert.deepEqual(await places(), wanted);
        assert.match(await page.locator("#gallery .place .told").first().innerText(), /%/);
        await addressSays("shows", String(id));
        await page.click('#panel [data-key="everything"]');
        await addressSays("shows", null);
        assert.deepEqual(problems, []);
    });

    test("the gallery is there after the dataset was read again while a frame was open", async () => {
        await page.goto("about:blank");
        await page.goto(`${origin}/view/#scene=home&camera=cam_00&mode=gallery&within=camera`);
        await page.locator("#gallery .place").first().waitFor();
        const before = await places();
        await page.locator("#gallery-frames").press("Enter");
        await painted();
        await page.keyboard.press("Shift+R");
        await page.locator(".toast", { hasText: "Read again" }).waitFor();
        await page.keyboard.press("a");
        await page.locator("#gallery .place").nth(before.length - 1).waitFor();
        assert.deepEqual(await places(), before);
    });

    test("two pictures stand one above the other where that makes them larger", async () => {
        await open("mode=side&layer=color&other=depth_meters");
        const panes = () => page.evaluate(() => window.view.stage.panes().map(({ x, y }) => [x > 0, y > 0]));
        assert.deepEqual(await panes(), [[false, false], [true, false]]);
        await page.setViewportSize({ width: 390, height: 844 });
        await page.waitForFunction(() => window.view.stage.panes()[1].y > 0);
        assert.deepEqual(await panes(), [[false, false], [false, true]]);
        const box = await page.locator("#stage").boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + 0.75 * box.height);
        await page.locator('#readout [data-side="1"] .value').waitFor();
        assert.equal(await page.evaluate(() => window.view.stage.pixel.side), 1);
        await page.setViewportSize({ width: 1280, height: 720 });
        await page.waitForFunction(() => window.view.stage.panes()[1].x > 0);
    });

    test("the columns are made wider by keys, and stay so", async () => {
        await open("layer=color");
        const width = async (id) => Math.round((await page.locator(id).boundingBox()).width);
        const before = [await width("#tree"), await width("#inspector")];
        for (const [id, key] of [["#tree", "ArrowRight"], ["#inspector", "ArrowLeft"]]) {
            await page.locator(`${id} [role=separator]`).focus();
            await page.keyboard.press(key);
        }
        assert.deepEqual([await width("#tree"), await width("#inspector")], before.map((one) => one + 16));
        await page.reload();
        await page.waitForSelector("body[data-ready=true]");
        assert.deepEqual([await width("#tree"), await width("#inspector")], before.map((one) => one + 16));
        await page.evaluate(() => localStorage.clear());
    });

    test("frames are chosen by limits, which stand in the address", async () => {
        const { frames } = await json("gallery/home");
        const noises = frames.filter((one) => one.version && one.camera === "cam_00").map((one) => one.noise).sort((a, b) => a - b);
        const limit = (noises[0] + noises[1]) / 2;
        await page.goto("about:blank");
        await page.goto(`${origin}/view/#scene=home&camera=cam_00&mode=gallery&within=camera`);
        await page.locator("#gallery .place").nth(noises.length - 1).waitFor();
        const max = page.locator('#panel input[aria-label="Noise, max"]');
        await max.fill(String(100 * limit));
        await max.press("Enter");
        await page.waitForFunction(() => document.querySelectorAll("#gallery .place").length === 1);
        await page.waitForFunction(() => location.hash.includes("limit=noise"));
        await page.reload();
        await page.locator("#gallery .place").first().waitFor();
        assert.equal((await places()).length, 1);
        await page.click('#panel [data-key="everything"]');
        await page.locator("#gallery .place").nth(noises.length - 1).waitFor();
        // The same by dragging over the bars; a click takes it back.
        const bars = page.locator("#panel .column-field", { hasText: "Noise" }).locator("svg");
        await bars.scrollIntoViewIfNeeded();
        const box = await bars.boundingBox();
        const share = (limit - noises[0]) / (noises[noises.length - 1] - noises[0]);
        await page.mouse.move(box.x + 1, box.y + box.height / 2);
        await page.mouse.down();
        await page.mouse.move(box.x + share * box.width, box.y + box.height / 2, { steps: 4 });
        await page.mouse.up();
        await page.waitForFunction(() => document.querySelectorAll("#gallery .place").length === 1);
        await page.waitForFunction(() => location.hash.includes("limit=noise"));
        const again = await page.locator("#panel .column-field", { hasText: "Noise" }).locator("svg").boundingBox();
        await page.mouse.click(again.x + again.width / 2, again.y + again.height / 2);
        await page.locator("#gallery .place").nth(noises.length - 1).waitFor();
        assert.deepEqual(problems, []);
    });
});
