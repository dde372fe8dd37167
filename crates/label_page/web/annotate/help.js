// The overlay of keys and the palette of commands, both made from the table of commands.

import { el } from "../shared/dom.js";
import { GESTURES, keyName } from "./commands.js";
import { matches } from "./names.js";

/** @typedef {import("./commands.js").Command} Command */

/** @param {string[]} keys */
const written = (keys) => el("span", {}, ...keys.slice(0, 2).map((key) => el("kbd", {}, keyName(key))));

/** @param {Command[]} table @returns {() => void} opens it */
export function helpOverlay(table) {
    const groups = [...new Set(table.map(({ group }) => group))];
    const row = (/** @type {string | Node} */ left, /** @type {Node} */ right) => el("div", {}, el("span", {}, left), right);
    const sections = groups.map((group) => el("section", {}, el("h3", {}, group), ...table.filter((one) => one.group === group).map(({ name, keys }) => row(name, written(keys)))));
    const mouse = el("section", {}, el("h3", {}, "Pointer and flying"), ...GESTURES.map(([gesture, does]) => row(does, el("span", { class: "quiet" }, gesture))));
    const dialog = el("dialog", { "aria-label": "Keys", id: "help" }, el("h2", {}, "Keys"), el("div", { class: "keys" }, mouse, ...sections), el("form", { method: "dialog" }, el("button", { autofocus: true }, "Close")));
    document.body.append(dialog);
    return () => {
        dialog.showModal();
        dialog.scrollTop = 0;
    };
}

/** @param {Command[]} table @returns {() => void} opens it */
export function palette(table) {
    const input = el("input", { type: "search", "aria-label": "Command", placeholder: "Command", role: "combobox", "aria-controls": "palette-list", "aria-expanded": "true" });
    const list = el("div", { role: "listbox", id: "palette-list", "aria-label": "Commands" });
    const dialog = el("dialog", { class: "palette", "aria-label": "Commands" }, input, list);
    document.body.append(dialog);
    /** @type {Command[]} */
    let found = [];
    let at = 0;
    function draw() {
        list.replaceChildren(...found.map((command, i) => el("div", { role: "option", id: `palette-${i}`, "aria-selected": i === at, onclick: () => run(command) }, el("span", {}, command.group === "Class" ? `Class ${command.name}` : command.name), written(command.keys))));
        input.setAttribute("aria-activedescendant", `palette-${at}`);
        list.children[at]?.scrollIntoView({ block: "nearest" });
    }
    function search() {
        found = table.filter(({ name, group }) => matches(`${name} ${group}`, input.value));
        at = 0;
        draw();
    }
    /** @param {Command} command */
    function run(command) {
        dialog.close();
        command.run();
    }
    input.addEventListener("input", search);
    input.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        const by = event.key === "ArrowDown" ? 1 : event.key === "ArrowUp" ? -1 : 0;
        if (by !== 0) {
            at = Math.min(found.length - 1, Math.max(0, at + by));
            draw();
            event.preventDefault();
        } else if (event.key === "Escape") {
            // The browser's own way is to empty the field first.
            event.preventDefault();
            dialog.close();
        } else if (event.key === "Enter" && found[at]) {
            event.preventDefault();
            run(found[at]);
        }
    });
    return () => {
        input.value = "";
        search();
        dialog.showModal();
        input.focus();
    };
}
