// The search of a layer by its name: type words, choose by arrows, Enter shows it.

import { el } from "../shared/dom.js";

/** @param {import("./session.js").Session} session @returns {() => void} opens it */
export function layerSearch(session) {
    const input = el("input", { type: "search", role: "combobox", "aria-label": "Find a layer", placeholder: "Find a layer", "aria-controls": "layer-list", "aria-expanded": "true", "aria-autocomplete": "list", autocomplete: "off", spellcheck: false });
    const list = el("div", { role: "listbox", id: "layer-list", "aria-label": "Layers" });
    const none = el("p", { class: "quiet", role: "status" });
    const dialog = el("dialog", { class: "search", id: "layer-search", "aria-label": "Find a layer" }, input, list, none);
    document.body.append(dialog);
    /** @type {string[]} */
    let found = [];
    let at = 0;
    const textOf = (/** @type {string} */ name) => `${session.looks.title(name)} ${name} ${session.looks.spec(name).description}`.toLowerCase();
    function draw() {
        list.replaceChildren(...found.map((name, i) => el("div", { role: "option", id: `layer-option-${i}`, "aria-selected": String(i === at), onclick: () => show(name) }, el("span", {}, session.looks.title(name)), session.looks.title(name) === name ? null : el("code", { class: "quiet" }, name))));
        list.hidden = found.length === 0;
        none.textContent = found.length === 0 ? "No layer of this frame has these words." : "";
        if (found.length > 0) input.setAttribute("aria-activedescendant", `layer-option-${at}`);
        else input.removeAttribute("aria-activedescendant");
        list.children[at]?.scrollIntoView({ block: "nearest" });
    }
    function search() {
        const words = input.value.toLowerCase().split(/\s+/u).filter(Boolean);
        const has = (/** @type {string} */ text) => words.every((/** @type {string} */ word) => text.includes(word));
        const all = session.layersOf(session.store.state.frame).filter((name) => has(textOf(name)));
        // What has the words in its name comes before what has them in its description.
        const isNamed = (/** @type {string} */ name) => has(`${session.looks.title(name)} ${name}`.toLowerCase());
        found = [...all.filter(isNamed), ...all.filter((name) => !isNamed(name))];
        at = 0;
        draw();
    }
    /** @param {string} name */
    function show(name) {
        dialog.close();
        session.store.set({ layer: name });
    }
    input.addEventListener("input", search);
    input.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        const by = /** @type {Record<string, number>} */ ({ ArrowDown: 1, ArrowUp: -1 })[event.key] ?? 0;
        if (by !== 0) {
            at = Math.min(found.length - 1, Math.max(0, at + by));
            draw();
        } else if (event.key === "Escape") dialog.close();
        else if (event.key === "Enter" && found[at]) show(found[at]);
        else return;
        event.preventDefault();
        event.stopPropagation();
    });
    return () => {
        if (session.store.state.mode === "gallery" || dialog.open) return;
        input.value = "";
        search();
        dialog.showModal();
        input.focus();
    };
}
