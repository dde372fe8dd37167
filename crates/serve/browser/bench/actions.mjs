// How many keys it takes to give every piece of a scene its class, with and without suggestions: a model of the page, not a person.
//
//     node bench/actions.mjs PROGRAM SCENE [TABLE NAME]
//
// The truth are the labels that the scene comes with, or those that TABLE (columns scene, material, nyu40_id) has for the materials of
// scene NAME. Pieces without a true class are left alone.
//
// A group is the pieces of one name, numbers aside, and one class. It costs: same name (1 key, where there are several), the digits of the
// class (1 or 2), Enter (1), which goes on to the next. Pieces whose name stands for several classes are groups of their own. With
// suggestions three keys come first (the tab, the slider, confirm), and wrong ones are labelled like unlabelled ones; finding the wrong
// ones is not counted. "One by one" looks at each group: a right suggestion is confirmed (1 key), and every decision counts. "Class by class"
// looks at all that is suggested as one class: each wrong group of it is rejected (a click and a decision), and the rest confirmed (2 keys: to
// its row, confirm). Things are pieces that get a class and an instance of their own: the digits, and Shift+Enter (2). Those of the scene's
// own instances are also made by clicks on each of their pieces, by whole objects (a click, the digits, Ctrl+Enter, and Shift+W where a group
// is within a group), and with copies at once (Shift+S; copies are taken for those that have pieces of the same shapes). Times are those of the
// keystroke-level model (Card, Moran & Newell, CACM 1980): 0.28 s per key, 1.3 s to point and click, and 1.35 s of thought per decision.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { stem } from "../../../label_page/web/annotate/names.js";
import { wholeOf } from "../../../label_page/web/annotate/whole_objects.js";

const KEY_S = 0.28;
const CLICK_S = 1.3;
const THOUGHT_S = 1.35;
const CONFIRM_KEYS = 3;

const [program, scene, table, name] = process.argv.slice(2);
if (!program || !scene) throw new Error("usage: node bench/actions.mjs PROGRAM SCENE [TABLE NAME]");

/** What the server says of the pieces; the labels go to a folder that is thrown away. */
async function piecesOf() {
    const folder = mkdtempSync(join(tmpdir(), "actions-"));
    const server = spawn(program, ["annotate", scene, "--labels", folder, "--no-open"], { stdio: ["ignore", "pipe", "inherit"] });
    const url = await new Promise((resolve, reject) => {
        server.stdout.on("data", (data) => {
            const found = String(data).match(/http:\/\/[^\s/]+/);
            if (found) resolve(found[0]);
        });
        server.on("exit", (code) => reject(new Error(`the program ended with ${code}`)));
    });
    const pieces = await (await fetch(`${url}/api/annotate/pieces`)).json();
    server.removeAllListeners("exit");
    const ended = once(server, "exit");
    server.kill();
    await ended;
    rmSync(folder, { recursive: true });
    return pieces;
}

/** Classes by material of one scene. Names in the table have no commas. */
function classesByMaterial() {
    const [header, ...rows] = readFileSync(table, "utf8").trim().split(/\r?\n/).map((line) => line.split(","));
    const [sceneAt, materialAt, classAt] = ["scene", "material", "nyu40_id"].map((column) => header.indexOf(column));
    return new Map(rows.filter((row) => row[sceneAt] === name).map((row) => [row[materialAt], Number(row[classAt])]));
}

/** Keys and decisions to label these pieces; with `right`, right suggestions are confirmed group by group. */
function cost(which, bare, truth, right = false) {
    const classes = new Map();
    for (const i of truth.keys()) if (truth[i] >= 1) classes.set(bare[i], (classes.get(bare[i]) ?? new Set()).add(truth[i]));
    const groups = new Map();
    for (const i of which) {
        const key = classes.get(bare[i]).size === 1 ? bare[i] : `piece ${i}`;
        groups.set(key, [...(groups.get(key) ?? []), i]);
    }
    let keys = 0;
    for (const members of groups.values()) {
        const isRight = right && members.every((i) => pieces.suggestions[i]?.semantic === truth[i]);
        keys += Number(members.length > 1) + (isRight ? 1 : 1 + String(truth[members[0]]).length);
    }
    return { keys, groups: groups.size };
}

/** Suggested pieces by name and class. */
function groupsOf(suggested) {
    const groups = {};
    for (const i of suggested) (groups[`${pieces.suggestions[i].semantic} ${bare[i]}`] ??= []).push(i);
    return groups;
}

/** Keys, clicks and decisions to make things of instances: piece by piece, by whole objects, and with copies at once. */
function costOfThings() {
    const things = new Map();
    for (const i of all) if (pieces.instance[i] >= 1) things.set(pieces.instance[i], [...(things.get(pieces.instance[i]) ?? []), i]);
    const state = { pieces, count: truth.length, removed: new Set() };
    const costs = { "things, by clicks": [], "things, whole objects": [], "things, whole objects and the same again": [] };
    const seen = new Set();
    for (const members of things.values()) {
        const label = String(truth[members[0]]).length;
        const byClicks = { clicks: members.length, keys: label + 2, groups: 1 };
        // Shift+W until the selection is the thing; one press is saved by Ctrl+Enter.
        let [found, presses] = [[members[0]], 0];
        while (found && found.length < members.length) {
            found = wholeOf(state, found);
            presses++;
        }
        const isWhole = found?.length === members.length && members.every((i) => found.includes(i));
        const whole = isWhole ? { clicks: 1, keys: label + 2 + 2 * Math.max(0, presses - 1), groups: 1 } : byClicks;
        costs["things, by clicks"].push(byClicks);
        costs["things, whole objects"].push(whole);
        // Copies have pieces of the same shapes; Shift+S labels them.
        const shape = members.map((i) => pieces.geometry_keys[i]).sort((a, b) => a - b).join(" ");
        const isFirst = !seen.has(shape);
        seen.add(shape);
        const copies = [...things.values()].filter((others) => others.map((i) => pieces.geometry_keys[i]).sort((a, b) => a - b).join(" ") === shape).length;
        if (isFirst) costs["things, whole objects and the same again"].push({ ...whole, keys: whole.keys + (copies > 1 ? 2 : 0) });
    }
    const sum = (list, what) => list.reduce((total, one) => total + one[what], 0);
    return { count: things.size, rows: Object.entries(costs).map(([row, list]) => ({ row, keys: sum(list, "keys"), clicks: sum(list, "clicks"), groups: sum(list, "groups") })) };
}

const pieces = await piecesOf();
const byMaterial = table ? classesByMaterial() : null;
const truth = byMaterial ? pieces.materials.map((material) => byMaterial.get(material) ?? -1) : pieces.semantic;
const bare = pieces.names.map(stem);
const all = truth.flatMap((one, i) => (one >= 1 ? [i] : []));
const digits = all.reduce((keys, i) => keys + String(truth[i]).length, 0);
const minutes = ({ keys, groups, clicks = 0 }) => ((keys * KEY_S + clicks * CLICK_S + groups * THOUGHT_S) / 60).toFixed(1);
console.log(`${all.length} of ${truth.length} pieces have a true class`);
console.log("| | suggested | wrong | keys | decisions | minutes |\n|---|---|---|---|---|---|");
for (const [row, keys] of [["piece by piece", digits + all.length], ["piece by piece, each a thing", digits + 2 * all.length]]) console.log(`| ${row} | | | ${keys} | ${all.length} | ${minutes({ keys, groups: all.length })} |`);
const plain = cost(all, bare, truth);
console.log(`| by names | | | ${plain.keys} | ${plain.groups} | ${minutes(plain)} |`);
const shown = cost(all, bare, truth, true);
console.log(`| by names, right suggestions one by one | | | ${shown.keys} | ${shown.groups} | ${minutes(shown)} |`);
for (const least of [0.95, 0.9, 0.8, 0.5]) {
    const suggested = all.filter((i) => pieces.suggestions[i]?.confidence >= least);
    const right = new Set(suggested.filter((i) => pieces.suggestions[i].semantic === truth[i]));
    const left = cost(all.filter((i) => !right.has(i)), bare, truth);
    left.keys += CONFIRM_KEYS;
    console.log(`| suggestions of ${least} and more | ${suggested.length} | ${suggested.length - right.size} | ${left.keys} | ${left.groups} | ${minutes(left)} |`);
}
for (const least of [0.9, 0.8, 0.5]) {
    const suggested = all.filter((i) => pieces.suggestions[i]?.confidence >= least);
    const groups = groupsOf(suggested);
    const wrong = Object.values(groups).filter((members) => members.some((i) => pieces.suggestions[i].semantic !== truth[i]));
    const right = new Set(Object.values(groups).filter((members) => !wrong.includes(members)).flat());
    const classes = new Set(suggested.map((i) => pieces.suggestions[i].semantic)).size;
    const left = cost(all.filter((i) => !right.has(i)), bare, truth);
    const sum = { keys: left.keys + 2 * classes, groups: left.groups + classes + wrong.length, clicks: wrong.length };
    console.log(`| suggestions of ${least} and more, class by class | ${suggested.length} | ${suggested.length - right.size} | ${sum.keys} + ${sum.clicks} clicks | ${sum.groups} | ${minutes(sum)} |`);
}
const things = costOfThings();
console.log(`\n${things.count} things\n\n| | keys | clicks | decisions | minutes |\n|---|---|---|---|---|`);
for (const one of things.rows) console.log(`| ${one.row} | ${one.keys} | ${one.clicks} | ${one.groups} | ${minutes(one)} |`);
