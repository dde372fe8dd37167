// The panel "Classes": colour, number and name of each class, those given last, and search. A class that is clicked is given to the selection.

import { el } from "../shared/dom.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { css, textOn } from "./colors.js";
import { matches } from "./names.js";

/** Classes in a row. */
const COLUMNS = 3;

/** @typedef {import("./state.js").LabelClass} LabelClass */

/** A button that chooses a class. @param {LabelClass} one @param {import("./actions.js").Actions} act */
function classButton({ id, name, color }, act) {
    const key = el("span", { class: "key number" }, String(id));
    [key.style.background, key.style.color] = [css(color), textOn(color)];
    return el("button", { "data-class": id, onclick: () => act.chooseClass(id) }, key, el("span", { class: "name" }, name));
}

/** @param {import("./state.js").State} state @param {import("./actions.js").Actions} act */
export function classesPanel(state, act) {
    const search = el("input", { type: "search", placeholder: "Search classes", "aria-label": "Search classes" });
    const grid = el("div", { class: "classes", role: "group", "aria-label": "Classes" });
    const rows = state.classes.map((one) => ({ ...one, button: classButton(one, act) }));
    grid.append(...rows.map(({ button }) => button));
    const matching = () => rows.filter(({ id, name }) => matches(name, search.value) || String(id) === search.value.trim());
    search.addEventListener("input", () => {
        const found = new Set(matching());
        for (const row of rows) row.button.hidden = !found.has(row);
    });
    search.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        const first = matching()[0];
        if (event.key !== "Enter" || !first) return;
        event.preventDefault();
        search.value = "";
        search.dispatchEvent(new Event("input"));
        act.stage.element.focus();
        act.chooseClass(first.id);
    });
    state.on(["currentClass", "layer"], () => {
        for (const { id, button } of rows) button.setAttribute("aria-pressed", String(state.layer === "semantic" && id === state.currentClass));
    });
    state.on(["labels"], () => {
        const counts = new Map();
        for (const id of state.pieces.semantic) counts.set(id, (counts.get(id) ?? 0) + 1);
        for (const { id, name, button } of rows) button.title = `${name}: ${counts.get(id) ?? 0} pieces`;
    });
    oneTabStop(grid, { columns: COLUMNS });
    return el("div", {}, el("div", { class: "head" }, search), recentClasses(state, act), el("div", { class: "scroll" }, grid));
}

/** The classes that were given last. @param {import("./state.js").State} state @param {import("./actions.js").Actions} act */
function recentClasses(state, act) {
    const row = el("div", { class: "classes recent", role: "group", "aria-label": "Recent classes" });
    state.on(["recent"], () => {
        const found = state.recent.map((id) => state.classById.get(id)).filter((one) => one !== undefined);
        row.replaceChildren(...found.map((one) => classButton(one, act)));
    });
    oneTabStop(row);
    return row;
}
