// Tools of the page that shows a dataset: reading by keys, search of layers, distances, points that are followed, one's own list of frames;
// and how the page copes with slow lines, damaged layers, tokens, and datasets that are not there yet.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { browser, dataset, serve, told } from "./room.mjs";

describe("tools", () => {
    let path, origin, page;
    const problems = [];
    const endings = [];

    before(async () => {
        const t = { after: (ending) => endings.push(ending) };
        path = dataset(t);
        execFileSync(process.env.ENFILADE_BINARY, ["make", path, "tracks", "--points", "40", "--scene", "home", "--quiet"], { stdio: ["ignore", "ignore", "inherit"] });
        origin = new URL((await serve(t, path, 0, "view")).url).origin;
        page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
        page.on("pageerror", (error) => problems.push(error.message));
    });

    after(async () => {
        for (const ending of endings.reverse()) await ending();
        assert.deepEqual(problems, []);
    });

    /** Opens a page at an address's hash. */
    async function open(hash, where = page, at = origin) {
        await where.goto("about:blank");
        await where.goto(`${at}/view/#${hash}`);
        await where.waitForSelector("body[data-ready=true]");
    }

    const painted = (where = page) => where.waitForFunction(() => document.querySelector("#stage").dataset.frame !== "" && document.querySelector("#busy").hidden);
    const says = (word, wanted) => page.waitForFunction(([word, wanted]) => new URLSearchParams(location.hash.slice(1)).get(word) === wanted, [word, wanted], { timeout: 15_000 });

    /** A copy of the dataset that the test may change. */
    function copy(t) {
        const folder = mkdtempSync(join(tmpdir(), "tools-"));
        t.after(() => rmSync(folder, { recursive: true, force: true }));
        cpSync(path, join(folder, "demo"), { recursive: true });
        return join(folder, "demo");
    }

    /** The place of a pixel, metres, as the server has it. */
    async function positionAt(x, y) {
        const response = await fetch(`${origin}/api/view/layer/home/cam_00/0/position`);
        const [, width] = response.headers.get("x-enfilade-shape").split(",").map(Number);
        const numbers = new Float32Array(await response.arrayBuffer());
        return [0, 1, 2].map((axis) => numbers[3 * (y * width + x) + axis]);
    }

    test("values are read pixel by pixel by keys, and told", async () => {
        await open("frame=0&layer=depth_meters");
        await painted();
        await page.locator("#stage").focus();
        await page.keyboard.press("Control+ArrowRight");
        assert.deepEqual(await page.evaluate(() => [window.view.stage.pixel.x, window.view.stage.pixel.y]), [80, 60]);
        await page.keyboard.press("Control+Shift+ArrowUp");
        assert.deepEqual(await page.evaluate(() => [window.view.stage.pixel.x, window.view.stage.pixel.y]), [80, 50]);
        const shown = await page.locator("#readout .value").first().innerText();
        await page.waitForFunction((value) => document.getElementById("live").textContent.includes(value), shown.trim());
        await page.keyboard.press("ArrowRight");
        await page.waitForFunction(() => /^Frame 1, 2 of 3/u.test(document.getElementById("live").textContent));
        assert.equal(await page.locator("#thumbnails").getAttribute("aria-activedescendant"), "thumb-1");
        assert.ok((await told(page)).length > 0);
    });

    test("a layer is found by words", async () => {
        await open("frame=0&layer=color");
        await painted();
        await page.locator("#stage").focus();
        await page.keyboard.press("Control+k");
        await page.keyboard.type("rough");
        assert.deepEqual(await page.locator("#layer-list [aria-selected=true] span").allInnerTexts(), ["roughness"]);
        await page.keyboard.press("Enter");
        await says("layer", "roughness");
        await page.click("#find-layer");
        await page.keyboard.type("no such layer");
        await page.getByText("No layer of this frame has these words.").waitFor();
        await page.keyboard.press("Escape");
    });

    test("the distance between two pixels is that of their surfaces", async () => {
        await open("frame=0&layer=color&ruler=40,100,120,90");
        await painted();
        const [a, b] = [await positionAt(40, 100), await positionAt(120, 90)];
        const distance = Math.hypot(...a.map((one, axis) => one - b[axis])).toFixed(3);
        await page.locator("#distance", { hasText: `${distance} m;` }).waitFor();
        // By keys: an end here, an end ten pixels on.
        await page.locator("#stage").focus();
        for (const key of ["Escape", "Control+ArrowRight", "j", "Control+Shift+ArrowRight", "j"]) await page.keyboard.press(key);
        await says("ruler", "80,60,90,60");
        await page.waitForFunction(() => / m; /u.test(document.getElementById("live").textContent));
        await page.keyboard.press("ArrowRight");
        await says("ruler", null);
    });

    test("the distance in 3D is that of the surfaces under the cursor", async () => {
        await open("frame=0&layer=color&mode=space");
        await page.waitForFunction(() => window.view.space?.stage?.settled && window.view.space.stage.mesh);
        const box = await page.locator("#space").boundingBox();
        const at = async (x, y) => {
            await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
            await page.mouse.move(box.x + x * box.width + 1, box.y + y * box.height);
            await page.waitForTimeout(100);
            await page.keyboard.press("j");
            return page.evaluate(() => window.view.space.stage.pointAt(...window.view.space.pointer).toArray());
        };
        const [a, b] = [await at(0.5, 0.6), await at(0.6, 0.7)];
        const distance = Math.hypot(...a.map((one, axis) => one - b[axis]));
        const words = await page.locator(".space-span").innerText();
        assert.ok(Math.abs(Number.parseFloat(words) - distance) < 2e-3 && /° from level$/u.test(words), `${words} ${distance}`);
        assert.equal(await page.locator("#distance").innerText(), words);
        await page.keyboard.press("Escape");
        await says("span", null);
    });

    test("one point is picked among those that are followed", async () => {
        await open("frame=0&layer=color&tracks=true");
        await painted();
        await page.waitForFunction(() => window.view.session.tracks.of(window.view.session.camera));
        await page.locator("#stage").focus();
        await page.keyboard.press("Shift+p");
        await page.waitForFunction(() => window.view.store.state.track > 0);
        const first = await page.evaluate(() => window.view.store.state.track);
        await page.locator("#panel", { hasText: `Point ${first} is seen here` }).waitFor();
        await page.keyboard.press("Escape");
        // The same by a click on it.
        const [x, y] = await page.evaluate((track) => {
            const { stage, session } = window.view;
            const { points, frames } = session.tracks.of(session.camera);
            const at = (track - 1) * frames.length + frames.indexOf(0);
            const place = stage.placement(stage.panes()[0]);
            const [height, width] = stage.pictureSize();
            const box = stage.element.getBoundingClientRect();
            return [box.left + (place.x + points[2 * at] * width * place.zoom) / stage.ratio, box.top + (place.y + points[2 * at + 1] * height * place.zoom) / stage.ratio];
        }, first);
        await page.mouse.click(x, y);
        await page.waitForFunction((track) => window.view.store.state.track === track, first);
        // It stays in the middle of an enlarged picture.
        await page.evaluate(() => window.view.store.set({ zoom: 8 }));
        await page.keyboard.press("ArrowRight");
        await says("frame", "1");
        const there = await page.evaluate((track) => {
            const { points, frames } = window.view.session.tracks.of(window.view.session.camera);
            const at = (track - 1) * frames.length + frames.indexOf(1);
            return [points[2 * at], points[2 * at + 1]];
        }, first);
        const middle = await page.evaluate(() => [window.view.store.state.x, window.view.store.state.y]);
        if (there.every((one) => one >= 0 && one <= 1)) assert.ok(there.every((one, axis) => Math.abs(one - middle[axis]) < 1e-5), `${there} ${middle}`);
    });

    test("frames are tagged and dropped, and the list is a table and lines of Python", async (t) => {
        await open("mode=gallery");
        await page.locator("#gallery-frames .place").nth(2).waitFor();
        for (const key of ["h", "ArrowRight", "r", "ArrowRight", "r", "r"]) await page.keyboard.press(key);
        await page.locator("#marks-count", { hasText: "1 tagged, 1 dropped." }).waitFor();
        const [download] = await Promise.all([page.waitForEvent("download"), page.click('[data-key="marks-save"]')]);
        const table = readFileSync(await download.path(), "utf8");
        assert.equal(table, "scene_name,camera_name,frame_id,mark\nhome,cam_00,0,tagged\nhome,cam_00,1,dropped\n");
        assert.match(await page.locator("#marks-python").innerText(), /dataset\.place\(i\) not in marked/u);
        await page.locator('[data-key="show"]').selectOption("kept");
        await page.waitForFunction(() => document.querySelectorAll("#gallery .place").length === 2);
        // Kept by the browser; and marked while one looks at a frame.
        await open("frame=2&layer=color");
        await painted();
        await page.locator("#stage").focus();
        await page.keyboard.press("r");
        await page.locator(".toast", { hasText: "cam_00 2: dropped" }).waitFor();
        await open("mode=gallery");
        await page.locator("#marks-count", { hasText: "1 tagged, 2 dropped." }).waitFor();
        await page.click('[data-key="marks-clear"]');
        const folder = mkdtempSync(join(tmpdir(), "marks-"));
        t.after(() => rmSync(folder, { recursive: true, force: true }));
        const load = async (text) => {
            writeFileSync(join(folder, "list.csv"), text);
            await page.locator("#marks-file").setInputFiles(join(folder, "list.csv"));
        };
        await load(table);
        await page.locator("#marks-count", { hasText: "1 tagged, 1 dropped." }).waitFor();
        await load("scene_name,camera_name,frame_id,mark\nhome,cam_00,x,tagged\n");
        await page.locator(".toast", { hasText: "list.csv, line 2: found home,cam_00,x,tagged, expected" }).waitFor();
        const python = process.env.ENFILADE_PYTHON;
        if (python) {
            writeFileSync(join(folder, "demo_frames.csv"), table);
            const lines = await page.locator("#marks-python").innerText();
            const dataset = "class D:\n    def __len__(self): return 3\n    def place(self, i): return ('home', 'cam_00', i)\ndataset = D()\n";
            assert.equal(execFileSync(python, ["-c", `${dataset}${lines}\nprint(frames)`], { cwd: folder, encoding: "utf8" }).trim(), "[0, 2]");
        }
    });

    test("one damaged layer of two is told in its own half", async (t) => {
        const damaged = copy(t);
        writeFileSync(join(damaged, "scenes", "home", "images", "scene_cam_00_geometry_hdf5", "frame.0000.normal_cam.hdf5"), "nothing");
        const at = new URL((await serve(t, damaged, 0, "view")).url).origin;
        await open("mode=side&frame=0&layer=color&other=normal_cam", page, at);
        await page.locator("#message").waitFor();
        const [message, stage] = [await page.locator("#message").boundingBox(), await page.locator("#stage").boundingBox()];
        assert.ok(message.x >= stage.x + stage.width / 2 && message.x + message.width <= stage.x + stage.width, JSON.stringify([message, stage]));
    });

    test("a scene without labels has the colours of its parts in 3D", async (t) => {
        const bare = copy(t);
        for (const name of ["mesh_objects_si.hdf5", "mesh_objects_sii.hdf5"]) rmSync(join(bare, "scenes", "home", "_detail", "mesh", name));
        const at = new URL((await serve(t, bare, 0, "view")).url).origin;
        await open("mode=space&frame=0", page, at);
        await page.waitForFunction(() => window.view.space?.stage?.mesh, null, { timeout: 30_000 });
        assert.equal(await page.evaluate(() => window.view.space.coloring), "part");
        assert.equal(await page.locator('select[aria-label="Colours of the surfaces"]').inputValue(), "part");
    });

    test("nothing is fetched ahead on a slow line before what is shown is there", async (t) => {
        const context = await (await browser(t)).newContext({ viewport: { width: 1280, height: 720 } });
        const slow = await context.newPage();
        const asked = [];
        await slow.route(/\/api\/view\/layer\//u, async (route) => {
            asked.push(decodeURIComponent(new URL(route.request().url()).pathname.split("/layer/")[1]));
            await new Promise((resume) => setTimeout(resume, 700));
            await route.continue();
        });
        await open("scene=home&camera=cam_00&frame=0&layer=color", slow);
        await painted(slow);
        const shown = asked.lastIndexOf("home/cam_00/0/color");
        assert.ok(asked.slice(0, shown + 1).every((one) => one === "home/cam_00/0/color"), asked.join(" "));
        await slow.waitForFunction(() => window.view.session.layer(1, "color")?.step === 1, null, { timeout: 15_000 });
        await context.close();
    });

    test("with a token, pages of the dataset show their pictures and lead to frames", async (t) => {
        const { url } = await serve(t, path, 0, "view", ["--token"]);
        const at = new URL(url).origin;
        const context = await (await browser(t)).newContext();
        const own = await context.newPage();
        await own.goto(url);
        await own.waitForSelector("body[data-ready=true]");
        const { pages } = await own.evaluate(() => fetch("/api/view/dataset").then((response) => response.json()));
        assert.ok(pages.length > 0);
        let links = 0;
        for (const { path: name } of pages.filter((one) => one.path.endsWith(".html"))) {
            await own.goto(`${at}/api/view/file/${name}`);
            await own.waitForLoadState("load");
            const broken = await own.locator("img").evaluateAll((all) => all.filter((one) => !one.complete || one.naturalWidth === 0).map((one) => one.getAttribute("src")));
            assert.deepEqual(broken, [], name);
            const link = own.locator('a[href*="/view/#"]').first();
            if ((await link.count()) === 0) continue;
            links++;
            await link.click();
            await own.waitForSelector("body[data-ready=true]");
        }
        assert.ok(links > 0, "some page leads to frames");
        // Who has no token reads why, on a page.
        const stranger = await (await browser(t)).newPage();
        await stranger.goto(`${at}/view/`);
        assert.equal(await stranger.locator("h1").innerText(), "the token is missing or wrong");
        await context.close();
    });

    test("an empty folder is looked at until a run has made something there", async (t) => {
        const folder = mkdtempSync(join(tmpdir(), "empty-"));
        const at = new URL((await serve(t, folder, 0, "view")).url).origin;
        await page.goto("about:blank");
        await page.goto(`${at}/view/`);
        await page.waitForSelector("body[data-ready=true]");
        await page.locator("#gallery-bar", { hasText: "0 frames" }).waitFor();
        const run = spawn(process.env.ENFILADE_BINARY, ["run", "--demo", folder, "--quiet", "--frames", "2", "--size", "96x72", "--samples", "2"], { stdio: "ignore" });
        t.after(async () => {
            run.kill("SIGKILL");
            if (run.exitCode === null && run.signalCode === null) await once(run, "exit");
            rmSync(folder, { recursive: true, force: true });
        });
        await page.locator("#gallery-frames .place").nth(1).waitFor({ timeout: 120_000 });
        await page.locator("#gallery-frames").press("Enter");
        await painted();
        assert.ok(await page.locator("#message").isHidden());
    });
});
