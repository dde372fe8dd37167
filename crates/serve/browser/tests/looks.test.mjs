// How the page looks: what must fit, what must not overlap, and what must be readable.

import assert from "node:assert/strict";
import { test } from "node:test";
import { browser, drag, open, room, select, serve, shown } from "./room.mjs";

const openRoom = async (t) => open(await browser(t), (await serve(t, room(t).file)).url);

/** Texts whose contrast to what is behind them is below 4.5, with the contrast; disabled controls aside. */
const faint = (page) =>
    page.evaluate(() => {
        const context = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
        const over = (color, below) => {
            context.fillStyle = `rgb(${below.join(" ")})`;
            context.fillRect(0, 0, 1, 1);
            context.fillStyle = color;
            context.fillRect(0, 0, 1, 1);
            return [...context.getImageData(0, 0, 1, 1).data].slice(0, 3);
        };
        const behind = (element) => (element ? over(getComputedStyle(element).backgroundColor, behind(element.parentElement)) : [255, 255, 255]);
        const luminance = (rgb) => rgb.map((v) => (v <= 10 ? v / 3294 : ((v / 255 + 0.055) / 1.055) ** 2.4)).reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
        const texts = [...document.querySelectorAll("body *")].filter((one) => one.checkVisibility() && !one.closest(":disabled, script, style, canvas, option, noscript") && [...one.childNodes].some((child) => child.nodeType === 3 && child.textContent.trim() !== ""));
        return texts.flatMap((one) => {
            const ground = behind(one);
            const [a, b] = [luminance(over(getComputedStyle(one).color, ground)), luminance(ground)].sort((x, y) => y - x);
            const contrast = (a + 0.05) / (b + 0.05);
            return contrast < 4.5 ? [`${contrast.toFixed(2)} ${one.textContent.slice(0, 30)}`] : [];
        });
    });

test("all 40 classes fit at 1280 × 720, with the recent ones", async (t) => {
    const page = await openRoom(t);
    const [content, room40] = await page.evaluate(() => {
        window.annotate.state.remember(5);
        const { scrollHeight, clientHeight } = document.querySelector("#panel-classes .scroll");
        return [scrollHeight, clientHeight];
    });
    assert.ok(content <= room40, `${content} > ${room40}`);
    assert.equal(await page.locator("#panel-classes .classes:not(.recent) button:visible").count(), 40);
});

test("nothing overlaps or sticks out in narrow and enlarged windows", async (t) => {
    const page = await openRoom(t);
    for (const [width, height] of [[1280, 720], [1024, 768], [640, 720], [390, 844]]) {
        await page.setViewportSize({ width, height });
        const wrong = await page.evaluate(() => {
            const boxes = [...document.querySelectorAll("#top button, #top select, #save-state, #scene-name, #current button, #tabs button")].map((one) => ({ text: one.textContent.slice(0, 20), box: one.getBoundingClientRect() }));
            const out = boxes.filter(({ box }) => box.left < 0 || box.right > innerWidth + 0.5).map(({ text }) => `${text} sticks out`);
            const meet = (a, b) => a.left < b.right - 0.5 && b.left < a.right - 0.5 && a.top < b.bottom - 0.5 && b.top < a.bottom - 0.5;
            return [...out, ...boxes.flatMap((a, i) => boxes.slice(i + 1).filter((b) => meet(a.box, b.box)).map((b) => `${a.text} meets ${b.text}`))];
        });
        assert.deepEqual(wrong, [], `${width} × ${height}`);
        const { width: seen, height: tall } = await page.locator("#stage").boundingBox();
        assert.ok(seen > 330 && tall >= 190, `the view has ${seen} × ${tall} at ${width} × ${height}`);
    }
});

test("the panel is made wider by dragging and by keys, and stays so", async (t) => {
    const page = await openRoom(t);
    const width = async () => Math.round((await page.locator("#side").boundingBox()).width);
    const before = await width();
    const border = page.getByRole("separator", { name: "Width of the panel" });
    const { x, y, width: wide, height } = await border.boundingBox();
    await drag(page, [x + wide / 2, y + height / 2], [x + wide / 2 - 60, y + height / 2]);
    assert.equal(await width(), before + 60);
    await border.focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await width(), before + 44);
    await page.locator(`[role=separator][aria-valuenow="${before + 44}"]`).waitFor();
    await page.reload();
    await shown(page);
    assert.equal(await width(), before + 44);
    await border.dblclick();
    assert.equal(await width(), before);
});

test("every text has a contrast of 4.5, in both themes", async (t) => {
    const page = await openRoom(t);
    for (const scheme of ["dark", "light"]) {
        await page.emulateMedia({ colorScheme: scheme });
        await select(page, "chair_1");
        await page.evaluate(() => {
            window.annotate.act.chooseTool("pen");
            window.annotate.edits.setDeaf(true);
        });
        for (const tab of ["Classes", "Pieces", "Suggested", "To do", "History", "Progress"]) {
            await page.getByRole("tab", { name: tab }).click();
            assert.deepEqual(await faint(page), [], `${scheme}, ${tab}`);
        }
        for (const key of ["9", "9"]) await page.keyboard.press(key);
        assert.deepEqual(await faint(page), [], `${scheme}, a wrong number`);
    }
});

test("the theme is the system's until another is chosen, which stays, and scripts see its colours", async (t) => {
    const page = await openRoom(t);
    const ground = () =>
        page.evaluate(async () => {
            const { themeColor } = await import(document.querySelector("link[rel=stylesheet]").href.replace("theme.css", "theme.js"));
            return [getComputedStyle(document.body).backgroundColor, themeColor("--ground")];
        });
    const [dark, light] = ["rgb(22, 24, 28)", "rgb(238, 240, 243)"];
    for (const [colorScheme, expected] of [["dark", dark], ["light", light]]) {
        await page.emulateMedia({ colorScheme });
        assert.deepEqual(await ground(), [expected, expected], colorScheme);
    }
    await page.keyboard.press("Shift+T");
    assert.deepEqual(await ground(), [dark, dark]);
    await page.reload();
    await shown(page);
    assert.deepEqual(await ground(), [dark, dark]);
    await page.keyboard.press("Shift+T");
    assert.deepEqual(await ground(), [light, light]);
});
