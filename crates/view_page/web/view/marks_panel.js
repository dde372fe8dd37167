// The list of frames that people tagged and dropped, beside the gallery: saved as a table, copied as Python, read from a table.

import { el } from "../shared/dom.js";
import { toast } from "../shared/toast.js";

/** @param {import("./marks.js").Marks} marks @returns {Node[]} */
export function marksPart(marks) {
    const [tagged, dropped] = [marks.count("tagged"), marks.count("dropped")];
    const isEmpty = tagged + dropped === 0;
    const file = el("input", { type: "file", accept: ".csv,text/csv", class: "visually-hidden", id: "marks-file", "aria-label": "Table of marked frames", tabindex: "-1", onchange: () => void load(marks, file) });
    const button = (/** @type {string} */ key, /** @type {string} */ text, /** @type {() => void} */ run, disabled = isEmpty) => el("button", { type: "button", "data-key": `marks-${key}`, disabled, onclick: run }, text);
    return [
        el("h2", {}, "My list"),
        el("p", { class: "quiet", id: "marks-count" }, isEmpty ? "H tags a frame, R drops it: here, and while one looks at it. This browser keeps the list." : `${tagged} tagged, ${dropped} dropped.`),
        el("div", { class: "marks" }, button("save", "Save as CSV", () => save(marks)), button("python", "Copy Python", () => void copy(marks)), button("load", "Load CSV", () => file.click(), false), button("clear", "Clear", () => marks.clear())),
        file,
        ...(isEmpty ? [] : [el("pre", { id: "marks-python", tabindex: "0", "aria-label": "Python for this list" }, marks.python())]),
    ];
}

/** @param {import("./marks.js").Marks} marks */
function save(marks) {
    const url = URL.createObjectURL(new Blob([marks.csv()], { type: "text/csv" }));
    el("a", { href: url, download: marks.file }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
    toast(`Saved ${marks.file}.`, "", "good");
}

/** @param {import("./marks.js").Marks} marks */
async function copy(marks) {
    try {
        await navigator.clipboard.writeText(marks.python());
        toast("The lines are on the clipboard.", `They read ${marks.file}.`, "good");
    } catch {
        toast("The clipboard cannot be written.", "Select the lines below and copy them.");
    }
}

/** @param {import("./marks.js").Marks} marks @param {HTMLInputElement} file */
async function load(marks, file) {
    const [chosen] = file.files ?? [];
    if (!chosen) return;
    try {
        toast(`${marks.read(await chosen.text())} frames are marked as ${chosen.name} says.`, "", "good");
    } catch (error) {
        toast(`${chosen.name}, ${/** @type {Error} */ (error).message}`, "Choose a table that this page has saved.");
    }
    file.value = "";
}
