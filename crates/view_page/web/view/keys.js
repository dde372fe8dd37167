// The keyboard: calls the action of a key, and shows the help from the same table.

import { byId, el } from "../shared/dom.js";

/** @typedef {{ keys: string[], shown?: string, says: string, does: (event: KeyboardEvent) => void, repeats?: boolean }} Key */
/** @typedef {{ title: string, keys: Key[] }} Group */

/**
 * Listens to the groups of keys. A key is written as `Shift+R` or `ArrowLeft`, in the names of KeyboardEvent.key.
 * @param {Group[]} groups
 */
export function listenToKeys(groups) {
    const known = new Map(groups.flatMap((group) => group.keys.flatMap((key) => key.keys.map((name) => /** @type {[string, Key]} */ ([name, key])))));
    addEventListener("keydown", (event) => {
        const target = /** @type {HTMLElement} */ (event.target);
        const typing = target.matches("input:not([type=range]):not([type=checkbox]), select, textarea");
        if (event.key === "Escape" && typing) target.blur();
        if (typing || document.querySelector("dialog[open]")) return;
        // A focused control keeps the keys that operate it.
        if (target.matches("button, a, tr, [role=tab], input") && ["Enter", " "].includes(event.key)) return;
        if (target.matches("input[type=range]") && event.key.startsWith("Arrow")) return;
        const letter = event.key.length === 1 && /[a-z]/i.test(event.key);
        const name = `${event.ctrlKey || event.metaKey ? "Ctrl+" : ""}${event.altKey ? "Alt+" : ""}${event.shiftKey && (letter || event.key.length > 1) ? "Shift+" : ""}${letter ? event.key.toUpperCase() : event.key}`;
        const key = known.get(name);
        if (!key || (event.repeat && key.repeats === false)) return;
        event.preventDefault();
        key.does(event);
    });
}

/** @param {Group[]} groups */
export function showHelp(groups) {
    const dialog = byId("help");
    const names = (/** @type {Key} */ key) => (key.shown ?? key.keys.join("  ")).split("  ").flatMap((name) => [el("kbd", {}, name), " "]);
    dialog.replaceChildren(
        el("h1", { id: "help-title" }, "Keys"),
        el("div", { class: "keys" }, ...groups.map((group) => el("section", {}, el("h2", {}, group.title), el("dl", {}, ...group.keys.flatMap((key) => [el("dt", {}, ...names(key)), el("dd", {}, key.says)]))))),
        el("p", { class: "quiet" }, "Mouse: wheel zooms, dragging moves, double click shows the whole picture, a click keeps an instance marked. The address contains everything that is shown."),
        el("form", { method: "dialog" }, el("button", { class: "primary", autofocus: true }, "Close")),
    );
    dialog.showModal();
    dialog.scrollTop = 0;
}
