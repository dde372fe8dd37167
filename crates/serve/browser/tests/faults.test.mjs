// The page that shows a dataset, where the dataset is damaged, rejected in part, or still growing.

import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readFileSync, readdirSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { browser, dataset, serve } from "./room.mjs";

describe("a dataset with faults", () => {
    let whole;
    const endings = [];

    before(() => {
        whole = dataset({ after: (ending) => endings.push(ending) });
    });

    after(() => endings.forEach((ending) => ending()));

    /** A copy of the dataset, which the test may damage. */
    function copy(t) {
        const folder = mkdtempSync(join(tmpdir(), "faults-"));
        t.after(() => rmSync(folder, { recursive: true, force: true }));
        cpSync(whole, join(folder, "demo"), { recursive: true });
        return join(folder, "demo");
    }

    test("a table that is damaged is told by its panel, and the scene is shown", async (t) => {
        const path = copy(t);
        writeFileSync(join(path, "scenes", "home", "_detail", "metadata_nodes.csv"), "node_id\n\"");
        const { url } = await serve(t, path, 0, "view");
        const page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
        await page.goto(`${new URL(url).origin}/view/#layer=color&tab=objects`);
        await page.waitForFunction(() => document.querySelector("#stage").dataset.frame !== "");
        await page.locator("#panel .loss code", { hasText: "metadata_nodes.csv" }).waitFor();
        assert.ok(await page.locator("#message").isHidden());
    });

    test("a report that cannot be read is told where its verdict would be", async (t) => {
        const path = copy(t);
        writeFileSync(join(path, "verify.json"), "{");
        const { url } = await serve(t, path, 0, "view");
        const page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
        await page.goto(`${new URL(url).origin}/view/#layer=color&frame=0`);
        const badge = page.locator("#verdict .badge", { hasText: "Report unreadable" });
        await badge.waitFor();
        assert.match(String(await badge.getAttribute("title")), /verify\.json cannot be read.*Run enfilade verify again/s);
    });

    test("what verification rejects is counted once, with reason, value and limit", async (t) => {
        const path = copy(t);
        const file = join(path, "verify.json");
        const report = JSON.parse(readFileSync(file, "utf8"));
        for (const frame of report.frame_values) frame.gates.depth_range = frame.frame === 1 ? 0.25 : 3;
        for (const frame of report.frame_values) frame.gates.recomposition = 60;
        writeFileSync(file, JSON.stringify(report));
        const { url } = await serve(t, path, 0, "view");
        const page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
        await page.goto(`${new URL(url).origin}/view/#layer=color&frame=0&tab=views`);
        await page.locator("#verdict", { hasText: "1 frame rejected" }).waitFor();
        const rejected = page.locator("#panel dt", { hasText: "Rejected" }).locator("xpath=following-sibling::dd[1]");
        assert.equal(await rejected.innerText(), "1");
        assert.match(await page.locator('#panel [data-rejected="1"]').innerText(), /rejected by verification: depth range 0\.25 m, limit at least 0\.5/);
        await page.click("#verdict button");
        await page.waitForFunction(() => document.querySelectorAll("#gallery .place").length === 1);
        assert.match(await page.locator("#gallery .place").getAttribute("title"), /depth range 0\.25 m/);
    });

    test("frames that are made while one looks appear by themselves", async (t) => {
        const path = copy(t);
        const images = join(path, "scenes", "home", "images");
        const records = join(path, "scenes", "home", "_detail", "cam_00", "frames");
        const later = [images, records].flatMap((folder) => readdirSync(folder, { recursive: true }).map((name) => join(folder, String(name))).filter((name) => name.includes("frame.0002.")));
        for (const name of later) renameSync(name, `${name}.later`);
        const { url } = await serve(t, path, 0, "view");
        const page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
        await page.goto(`${new URL(url).origin}/view/#layer=color&frame=0`);
        await page.locator("#frame-number", { hasText: "1 of 2" }).waitFor();
        // Once the page has asked and was told that there are two.
        await page.waitForFunction(() => window.view?.watch.last !== "", null, { timeout: 15_000 });
        for (const name of later) renameSync(`${name}.later`, name);
        await page.locator("#frame-number", { hasText: "1 of 3" }).waitFor({ timeout: 15_000 });
    });

    test("scenes, cameras and the verdict of a dataset in the making appear by themselves", async (t) => {
        const path = copy(t);
        const later = [join("scenes", "home"), "verify.json"].map((name) => [join(path, name), join(path, "..", `later_${name.replaceAll(/[/\\\\]/g, "_")}`)]);
        for (const [there, aside] of later) renameSync(there, aside);
        const { url } = await serve(t, path, 0, "view");
        const page = await (await browser(t)).newPage({ viewport: { width: 1280, height: 720 } });
        await page.goto(`${new URL(url).origin}/view/#layer=color`);
        await page.locator("#message h2", { hasText: "The dataset has no scenes" }).waitFor();
        assert.equal(await page.locator("#verdict .badge").count(), 0);
        // The scene is there first, then its camera.
        const [[scene, aside], [report, kept]] = later;
        const ofCamera = [join("_detail", "cam_00"), "images"].map((name, i) => [name, join(path, "..", `later_${i}`)]);
        for (const [name, to] of ofCamera) renameSync(join(aside, name), to);
        renameSync(aside, scene);
        await page.locator("#message h2", { hasText: "has no cameras" }).waitFor({ timeout: 15_000 });
        for (const [name, from] of ofCamera) renameSync(from, join(scene, name));
        renameSync(kept, report);
        await page.waitForFunction(() => document.querySelector("#stage").dataset.frame !== "", null, { timeout: 15_000 });
        await page.locator("#verdict .badge").first().waitFor({ timeout: 15_000 });
        assert.ok(await page.locator("#message").isHidden());
    });

    test("the program ends at once, also while a page is open", async (t) => {
        const { url, port, end } = await serve(t, whole, 0, "view");
        const page = await (await browser(t)).newPage();
        await page.goto(url);
        await page.waitForSelector("body[data-ready=true]");
        const begin = performance.now();
        await end("SIGTERM");
        const seconds = (performance.now() - begin) / 1000;
        // Some hundredths of a second, on a machine that does nothing else; one that waited for the page would take many.
        assert.ok(seconds < 2, `${seconds} s`);
        await serve(t, whole, port, "view");
    });
});
