// The panel "Classes": colour, number and name of each class, and how many pieces have it; search.

import { el } from "../shared/dom.js";
import { css } from "./colors.js";

/** @param {import("./state.js").State} state @param {import("./actions.js").Actions} act */
export function classesPanel(state, act) {
    const search = el("input", { type: "search", placeholder: "Search classes", "aria-label": "Search classes" });
    const grid = el("div", { class: "classes", role: "group", "aria-label": "Classes" });
    const rows = state.classes.map(({ id, name, color }) => {
        const swatch = el("span", { class: "swatch" });
        swatch.style.background = css(color);
        const count = el("span", { class: "quiet number" });
        const choose = () => act.classByNumber(id);
        const button = el("button", { "data-class": id, onclick: choose, ondblclick: () => void act.assign() }, swatch, el("span", { class: "quiet number" }, String(id)), el("span", { class: "name", title: name }, name), count);
        return { id, name, button, count };
    });
    grid.append(...rows.map(({ button }) => button));
    const matching = () => rows.filter(({ id, name }) => name.includes(search.value.toLowerCase().trim()) || String(id) === search.value.trim());
    search.addEventListener("input", () => {
        const found = new Set(matching());
        for (const row of rows) row.button.hidden = !found.has(row);
    });
    search.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        const first = matching()[0];
        if (event.key !== "Enter" || !first) return;
        act.classByNumber(first.id);
        search.value = "";
        search.dispatchEvent(new Event("input"));
        search.blur();
    });
    state.on(["currentClass", "layer"], () => {
        for (const { id, button } of rows) button.setAttribute("aria-pressed", String(state.layer === "semantic" && id === state.currentClass));
    });
    state.on(["labels"], () => {
        const counts = new Map();
        for (const id of state.pieces.semantic) counts.set(id, (counts.get(id) ?? 0) + 1);
        for (const { id, count } of rows) count.textContent = counts.get(id) ?? "";
    });
    return el("div", {}, el("div", { class: "head" }, search), el("div", { class: "scroll" }, grid));
}
