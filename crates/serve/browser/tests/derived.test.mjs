// What is derived from frames or stored apart, on the page that shows a dataset.

import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { browser, dataset, derive, enlarge, serve } from "./room.mjs";

describe("what is derived", () => {
    let origin, page;
    const problems = [];
    const endings = [];

    before(async () => {
        const t = { after: (ending) => endings.push(ending) };
        const path = dataset(t, ["--fixtures"]);
        enlarge(path);
        derive(path);
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
        await page.goto(`${origin}/view/#scene=home&camera=cam_00&frame=0&${hash}`);
        await page.waitForSelector("body[data-ready=true]");
        await painted();
    }

    const painted = () => page.waitForFunction(() => document.querySelector("#stage").dataset.frame !== "" && document.querySelector("#busy").hidden);
    const addressSays = (word, wanted) => page.waitForFunction(([word, wanted]) => new URLSearchParams(location.hash.slice(1)).get(word) === wanted, [word, wanted], { timeout: 15_000 });
    const json = (path) => fetch(`${origin}/api/view/${path}`).then((response) => response.json());
    const pointAtMiddle = async (shareOfWidth = 0.5) => {
        const box = await page.locator("#stage").boundingBox();
        await page.mouse.move(box.x + box.width * shareOfWidth, box.y + box.height / 2);
    };

    test("all of it is in the list of layers, and is shown with its values", async () => {
        const { derived, frames } = await json("camera/home/cam_00");
        await open("layer=color");
        const groups = await page.locator("#layer-0 optgroup").evaluateAll((all) => all.map((one) => one.label));
        for (const group of ["Light by fixture", "Surfaces along rays", "To other frames", "Sensors"]) assert.ok(groups.includes(group), `${group}: ${groups}`);
        const titles = await page.locator("#layer-0 option").allTextContents();
        const there = frames[0].derived.map((at) => derived[at]);
        for (const { name, title } of there) {
            assert.ok(titles.includes(title), title);
            await page.selectOption("#layer-0", name);
            await painted();
            assert.ok(await page.locator("#message").isHidden(), `${name}: ${await page.locator("#message").innerText()}`);
            await pointAtMiddle();
            const line = page.locator(`#readout [data-layer="${name}"]`);
            await line.locator(".value").waitFor();
            assert.match(await line.locator(".value").innerText(), /\d|NaN/, name);
            assert.ok((await line.innerText()).includes(title), title);
        }
        assert.deepEqual(problems, []);
    });

    test("the light of a fixture is shown by the curve of color", async () => {
        await open("layer=fixture_01_diffuse_illumination");
        await page.locator("#panel #tone").waitFor();
        assert.match(await page.locator("#heading-0 .legend").innerText(), /90th percentile at 0\.8/);
        assert.match(await page.locator("#panel h2").nth(1).innerText(), /^1 \w+, illumination/);
    });

    test("the classes of the second surface have names, and its sides have words", async () => {
        await open("layer=surface_semantic.2");
        await pointAtMiddle();
        await page.locator('#readout [data-layer="surface_semantic.2"]', { hasText: /[a-z]{3}/ }).waitFor();
        await page.selectOption("#layer-0", "surface_side.1");
        await page.locator("#panel", { hasText: "2  back" }).waitFor();
    });

    test("a click on a partner compares with it, also where another camera took it", async () => {
        const { partners } = await json("pairs/home/cam_00/0");
        const other = partners.find((one) => one.camera === "cam_01");
        await open("layer=color&tab=pairs");
        const card = page.locator(`#panel [data-partner="${other.camera}/${other.frame}"]`);
        assert.match(await card.innerText(), /sees \d+(\.\d)? % of this\s+this sees \d+(\.\d)? % of it\s+\d+\.\d\d m apart, turned \d+°/);
        await card.click();
        await addressSays("otherCamera", "cam_01");
        await page.waitForFunction(() => window.view.stage.last.length === 2);
        assert.equal(await page.locator("#other-camera").innerText(), "cam_01 ");
        assert.deepEqual(await page.evaluate(() => window.view.stage.last.map(({ camera, frame, layer }) => [camera.name, frame, layer])), [["cam_00", 0, "color"], ["cam_01", other.frame, "color"]]);
        await pointAtMiddle(0.25);
        assert.match(await page.locator('#readout [data-side="1"]').innerText(), /cam_01 #\d+ +\d/);
        await page.fill("#frame-1", "");
        await page.locator("#frame-1").press("Enter");
        await addressSays("otherCamera", null);
        assert.deepEqual(problems, []);
    });

    test("tracks are drawn over the picture where their points are", async () => {
        await open("layer=color");
        await page.keyboard.press("p");
        await addressSays("tracks", "true");
        await page.waitForFunction(() => window.view.session.tracks.of(window.view.session.camera));
        await page.waitForTimeout(200);
        const drawn = await page.evaluate(() => {
            const { session, stage } = window.view;
            const { points, occluded, frames } = session.tracks.of(session.camera);
            const [place, [height, width]] = [stage.placement(stage.panes()[0]), stage.pictureSize()];
            const { canvas } = stage.overlay;
            const pen = canvas.getContext("2d");
            const covered = (at) => pen.getImageData(Math.round(place.x + points[2 * at] * width * place.zoom), Math.round(place.y + points[2 * at + 1] * height * place.zoom), 1, 1).data[3] > 0;
            const seen = [...occluded.keys()].filter((at) => at % frames.length === 0 && !occluded[at]);
            return { points: seen.length, covered: seen.filter(covered).length };
        });
        assert.ok(drawn.points > 5 && drawn.covered === drawn.points, JSON.stringify(drawn));
        assert.ok(await page.locator("#panel #tracks").isChecked());
    });

    test("an instance has its words, and links to those that it stands on or beside", async () => {
        const { described } = await json("scene/home");
        const relation = described.relations.find((one) => one.object > 0);
        await open(`layer=color&tab=objects&instance=${relation.subject}`);
        const name = described.instances.find((one) => one.instance === relation.object).name;
        const link = page.locator(`#panel [data-related="${relation.object}"]`).first();
        assert.equal(await link.innerText(), name);
        await link.click();
        await addressSays("instance", String(relation.object));
        await page.locator("#panel h2", { hasText: `Instance ${relation.object}` }).waitFor();
        await open("layer=color&tab=frame");
        const { words } = await json("frame/home/cam_00/0");
        assert.equal(await page.locator("#caption").innerText(), words.caption);
        await page.locator("#panel h2", { hasText: "Rooms" }).waitFor();
    });
});
