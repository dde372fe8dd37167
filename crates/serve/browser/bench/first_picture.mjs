// How long the two pages take on a dataset, on this machine's own network and on a slow one: view until its first picture, annotate until its
// tools work on all of the scene.
//
//     node bench/first_picture.mjs PROGRAM DATASET [MBIT_PER_S]
//
// A cold load has an empty cache, a warm one the cache of a load before. The slow network is Chromium's emulation, by default of 1 Mbit/s
// and 40 ms. "Picture" is a small picture of the frame or the whole one, whichever is shown first.

import { chromium } from "playwright-core";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const [program, dataset, mbit = "1"] = process.argv.slice(2);
if (!program || !dataset) throw new Error("usage: node bench/first_picture.mjs PROGRAM DATASET [MBIT_PER_S]");

/** A server of a page, and its address. @param {string[]} words of the command */
async function serve(...words) {
    const child = spawn(program, [...words, "--no-open"], { stdio: ["ignore", "pipe", "inherit"] });
    const url = await new Promise((resolve) => {
        let said = "";
        child.stdout.on("data", (bytes) => {
            said += bytes;
            const found = said.match(/http:\/\/\S+/);
            if (found) resolve(found[0]);
        });
    });
    return { child, url };
}

const labels = mkdtempSync(join(tmpdir(), "labels-"));
const servers = { view: await serve("view", dataset), annotate: await serve("annotate", dataset, "--labels", labels) };
const browser = await chromium.launch({ executablePath: process.env.ENFILADE_CHROMIUM ?? "/usr/bin/chromium", args: ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });

/** Seconds until something is shown, and bytes on the wire. @param {import("playwright-core").Page} page @param {string} url @param {() => boolean} there */
async function load(page, url, there) {
    const session = await page.context().newCDPSession(page);
    let bytes = 0;
    session.on("Network.loadingFinished", ({ encodedDataLength }) => (bytes += encodedDataLength));
    await session.send("Network.enable");
    const rate = Number(page.slow) * 125_000;
    if (rate) await session.send("Network.emulateNetworkConditions", { offline: false, latency: 40, downloadThroughput: rate, uploadThroughput: rate });
    const begin = performance.now();
    await page.goto(url, { waitUntil: "commit" });
    await page.waitForFunction(there, null, { timeout: 180_000, polling: 30 });
    const seconds = ((performance.now() - begin) / 1000).toFixed(2);
    await session.detach();
    return `${seconds} s, ${(bytes / 1000).toFixed(0)} kB`;
}

const picture = () => (document.querySelector("#stage")?.dataset.frame ?? "") !== "";
const usable = () => window.annotate?.stage.settled && document.querySelector("#loading").hidden;
const gallery = () => [...document.querySelectorAll("#gallery img")].some((image) => image.complete && image.naturalWidth > 0);
for (const slow of ["0", mbit]) {
    for (const [what, verb, hash, there] of [["frame", "view", "#mode=one&frame=0&layer=color", picture], ["gallery", "view", "", gallery], ["annotate", "annotate", "", usable]]) {
        const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
        for (const state of ["cold", "warm"]) {
            const page = await context.newPage();
            Object.assign(page, { slow });
            console.log(`${slow === "0" ? "own machine" : `${slow} Mbit/s`}, ${what}, ${state}: ${await load(page, `${servers[verb].url}${hash}`, there)}`);
            await page.close();
        }
        await context.close();
    }
}
await browser.close();
for (const { child } of Object.values(servers)) {
    child.kill("SIGTERM");
    await once(child, "exit");
}
rmSync(labels, { recursive: true });
