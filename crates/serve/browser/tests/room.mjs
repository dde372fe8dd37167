// What the tests share: a small room as a scene file, a server on it, a browser, and strokes on the view.

import { chromium } from "playwright-core";
import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { appendFileSync, cpSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";

/** Graphics by the processor, so that every machine draws alike; nothing that talks to the network. */
const ARGUMENTS = [
    "--headless=new", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    // Only what is drawn by WebGL needs it; the rest of the page is cheaper without.
    "--disable-gpu-rasterization", "--disable-gpu-compositing",
];

/** Boxes of the room: name, corner, corner, metres; two chairs are alike, and `lamps` are two boxes in one part. */
const ROOM = [
    ["floor", [[[-3, -3, -0.1], [3, 3, 0]]]],
    ["wall_back", [[[-3, 2.9, 0], [3, 3, 2.5]]]],
    ["chair_1", [[[-1.8, 0, 0], [-1.2, 0.6, 0.9]]]],
    ["chair_2", [[[-0.6, 0, 0], [0, 0.6, 0.9]]]],
    ["table_1", [[[0.6, 0, 0], [1.4, 0.8, 0.8]]]],
    ["lamps", [[[-1, 1.6, 0.5], [-0.6, 2, 1.5]], [[0.8, 1.6, 1], [1.2, 2, 1.6]]]],
];

/** Boxes as a Wavefront file. */
function obj(parts) {
    let [text, corners] = ["", 0];
    for (const [name, boxes] of parts) {
        text += `o ${name}\nusemtl ${name}\n`;
        for (const [[x0, y0, z0], [x1, y1, z1]] of boxes) {
            for (const z of [z0, z1]) for (const y of [y0, y1]) for (const x of [x0, x1]) text += `v ${x} ${z} ${-y}\n`;
            for (const face of [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]]) text += `f ${face.map((v) => v + corners).join(" ")}\n`;
            corners += 8;
        }
    }
    return text;
}

/** A fresh folder with the room, which the test's end removes; or the room anew in a folder. @param {import("node:test").TestContext} t @param {[string, number[][][]][]} [more] boxes beside it @param {string} [again] the folder */
export function room(t, more = [], again) {
    const folder = again ?? mkdtempSync(join(tmpdir(), "annotate-"));
    if (!again) t.after(() => rmSync(folder, { recursive: true, force: true }));
    writeFileSync(join(folder, "room.obj"), obj([...ROOM, ...more]));
    return { folder, file: join(folder, "room.obj"), labels: join(folder, "room.obj.labels") };
}

/** The program under test. */
function program() {
    const named = process.env.ENFILADE_BINARY;
    if (!named) throw new Error("ENFILADE_BINARY names no program; run these tests by `cargo xtask browser`");
    return named;
}

/** A small dataset of a generated home with every layer but the denoised ones, which the test's end removes. @param {import("node:test").TestContext} t @param {string[]} [more] options */
export function dataset(t, more = []) {
    const folder = mkdtempSync(join(tmpdir(), "dataset-"));
    t.after(() => rmSync(folder, { recursive: true, force: true }));
    const path = join(folder, "demo");
    execFileSync(program(), ["run", "--demo", path, "--quiet", "--frames", "3", "--size", "160x120", "--samples", "2", "--extra", "--light-parts", ...more], { stdio: ["ignore", "ignore", "inherit"] });
    return path;
}

/** Adds to a dataset what is made of its frames on request. @param {string} path */
export function derive(path) {
    const sensors = join(path, "sensors.toml");
    writeFileSync(sensors, '[[camera]]\nname = "phone"\nformat = "png"\n\n[[lidar]]\nname = "spin"\nelevations_deg = [-5, 0, 5]\nazimuth_deg = [-20, 20]\ncolumns = 30\n');
    const products = [["pairs"], ["flow", "--step", "1"], ["tracks", "--points", "40"], ["surfaces", "--layers", "2"], ["words"], ["sensors", "--sensors", sensors]];
    for (const product of products) execFileSync(program(), ["make", path, ...product, "--scene", "home", "--quiet"], { stdio: ["ignore", "ignore", "inherit"] });
}

/** Adds to a dataset the camera `cam_01`, which is `cam_00` but for the seed of its records, and the scene `unmeshed`, which has no mesh folder. @param {string} path */
export function enlarge(path) {
    const scene = join(path, "scenes", "home");
    const images = join(scene, "images");
    for (const name of readdirSync(images)) cpSync(join(images, name), join(images, name.replace("cam_00", "cam_01")), { recursive: true });
    cpSync(join(scene, "_detail", "cam_00"), join(scene, "_detail", "cam_01"), { recursive: true });
    appendFileSync(join(scene, "_detail", "metadata_cameras.csv"), "cam_01\n");
    const records = join(scene, "_detail", "cam_01", "frames");
    for (const name of readdirSync(records)) {
        const text = readFileSync(join(records, name), "utf8").replaceAll("cam_00", "cam_01").replace(/"seed": \d+/, '"seed": 4711');
        writeFileSync(join(records, name), text);
    }
    const bare = join(path, "scenes", "unmeshed");
    cpSync(scene, bare, { recursive: true });
    rmSync(join(bare, "_detail", "mesh"), { recursive: true });
}

/** Starts the program; resolves when it tells its address. @param {import("node:test").TestContext} t @param {string} file @param {number} [port] @param {string} [verb] @param {string[]} [more] options */
export async function serve(t, file, port = 0, verb = "annotate", more = []) {
    const child = spawn(program(), [verb, file, "--no-open", "--port", String(port), ...more], { stdio: ["ignore", "pipe", "pipe"] });
    t.after(() => child.kill("SIGKILL"));
    let said = "";
    const url = await new Promise((resolve, reject) => {
        const hear = (bytes) => {
            said += bytes;
            const found = said.match(/http:\/\/\S+/);
            if (found) resolve(found[0]);
        };
        child.stdout.on("data", hear);
        child.stderr.on("data", hear);
        child.on("exit", (code) => reject(new Error(`the program ended with ${code}: ${said}`)));
    });
    const end = async (signal = "SIGTERM") => {
        const ended = once(child, "exit");
        child.kill(signal);
        await ended;
    };
    return { url, port: Number(new URL(url).port), end };
}

/** The browser of a file's tests, from the first that needs it to the last. @type {Promise<import("playwright-core").Browser> | undefined} */
let launched;
after(async () => (await launched)?.close());

/** The browser of these tests; the test's end closes the windows that it opened. @param {import("node:test").TestContext} t */
export async function browser(t) {
    launched ??= chromium.launch({ executablePath: process.env.ENFILADE_CHROMIUM ?? "/usr/bin/chromium", args: ARGUMENTS });
    const one = await launched;
    const before = new Set(one.contexts());
    t.after(() => Promise.all(one.contexts().filter((context) => !before.has(context)).map((context) => context.close())));
    return one;
}

/** The page, once all of the scene is shown. Errors of the page fail the test. A slow machine does not end numbers that are being typed. @param {import("playwright-core").BrowserContext | import("playwright-core").Browser} where @param {string} url */
export async function open(where, url) {
    const page = await where.newPage({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce" });
    page.on("pageerror", (error) => {
        throw error;
    });
    await page.goto(url);
    await shown(page);
    await page.evaluate(() => {
        window.annotate.act.digits.pauseMs = 600_000;
    });
    return page;
}

/** Waits until all of the scene is shown. */
export const shown = (page) => page.waitForFunction(() => window.annotate?.stage.settled && !document.getElementById("loading").checkVisibility());

/** Looks at the room from the front, everything in sight. */
export async function lookFromFront(page) {
    await page.evaluate(() => {
        const { act, stage } = window.annotate;
        // A flight whose end is still being asked for would come after this.
        act.looking.flights++;
        stage.goTo({ position: [0, -5, 2], orientation: [1, 0, 0, 0, 0.1, -0.995, 0, 0.995, 0.1], fov_y_deg: 50 }, { instant: true });
    });
    await shown(page);
}

/** A pixel of the window at which a piece is seen, away from its edges. @param {string} name */
export function pixelOf(page, name) {
    return page.evaluate((wanted) => {
        const { stage, state } = window.annotate;
        const piece = state.pieces.names.findIndex((one) => one.includes(wanted));
        const { left, top, width, height } = stage.element.getBoundingClientRect();
        const seen = (x, y) => stage.seenAt(x, y).piece === piece;
        // Each look waits for the graphics: at a stretch of a row first, then at its pixels.
        const stretch = 64;
        for (let y = 8; y < height - 8; y += 4)
            for (let from = 8; from < width - 8; from += stretch) {
                const to = Math.min(from + stretch, width - 8);
                if (!stage.seenIn([from, y, to - 1, y]).has(piece)) continue;
                for (let x = from; x < to; x += 4) if (seen(x, y) && seen(x - 6, y) && seen(x + 6, y) && seen(x, y + 6) && seen(x, y - 6)) return [left + x, top + y];
            }
        throw new Error(`${wanted} is not seen`);
    }, name);
}

/** Drags from one pixel to another. */
export async function drag(page, [x0, y0], [x1, y1]) {
    await page.mouse.move(x0, y0);
    await page.mouse.down();
    await page.mouse.move((x0 + x1) / 2, (y0 + y1) / 2);
    await page.mouse.move(x1, y1);
    await page.mouse.up();
}

/** Draws from one pixel to another with the tool, or with Shift held if none is chosen. */
export async function draw(page, from, to) {
    const shift = await page.evaluate(() => !window.annotate.state.drawMode);
    if (shift) await page.keyboard.down("Shift");
    await drag(page, from, to);
    if (shift) await page.keyboard.up("Shift");
    await saved(page);
}

/** Selects the first piece whose name has this word. */
export const select = (page, name) =>
    page.evaluate((wanted) => {
        const { state } = window.annotate;
        state.select([state.pieces.names.findIndex((one) => one.includes(wanted))]);
    }, name);

/** Names of what is selected. */
export const selected = (page) => page.evaluate(() => [...window.annotate.state.selection].map((piece) => window.annotate.state.name(piece)).sort());

/** What the view shows around a pixel of the window: red, green and blue of each pixel. */
export const pictureAt = (page, [x, y], side = 24) =>
    page.evaluate(([left, top, size]) => {
        const { stage } = window.annotate;
        const box = stage.element.getBoundingClientRect();
        stage.drawPicture();
        const bytes = new Uint8Array(size * size * 4);
        stage.gl.readPixels(left - box.left - size / 2, box.bottom - top - size / 2, size, size, stage.gl.RGBA, stage.gl.UNSIGNED_BYTE, bytes);
        return Array.from({ length: size * size }, (_, i) => [...bytes.subarray(4 * i, 4 * i + 3)]);
    }, [x, y, side]);

/** Waits until every edit is acknowledged. */
export async function saved(page) {
    await page.waitForTimeout(80);
    await page.waitForFunction(() => window.annotate.edits.queue.length === 0 && !window.annotate.edits.offline, null, { timeout: 15000 });
}

/** Class and instance of the first piece whose name has this word. */
export const labelOf = (page, name) =>
    page.evaluate((wanted) => {
        const { names, semantic, instance } = window.annotate.state.pieces;
        const piece = names.findIndex((one) => one.includes(wanted));
        return [semantic[piece], instance[piece]];
    }, name);

/** Text of the line that screen readers are told. */
export const told = (page) => page.locator("#live").textContent();
