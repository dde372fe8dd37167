// The panel "Pieces": all pieces, to search by name, sort by column and select.

import { el, spaced } from "../shared/dom.js";
import { css } from "./colors.js";
import { PieceList } from "./list.js";
import { matches } from "./names.js";

/** A class with its colour. @param {import("./state.js").State} state @param {number} id */
export function classCell(state, id) {
    const one = state.classById.get(id);
    if (!one) return el("span", { class: "quiet" }, "none", el("span", { class: "visually-hidden" }, " as class"));
    const swatch = el("span", { class: "swatch" });
    swatch.style.background = css(one.color);
    return el("span", {}, swatch, ` ${one.name}`);
}

/** A cell with words around it for screen readers. @param {string} before @param {string} text @param {string} [after] */
const unseen = (before, text, after = "") => el("span", {}, before ? el("span", { class: "visually-hidden" }, before) : null, text, after ? el("span", { class: "visually-hidden" }, after) : null);

/** Selects a piece from a list; with more, adds it or takes it out. @param {import("./state.js").State} state */
export const selecting = (state) => (/** @type {number} */ piece, /** @type {boolean} */ more) => {
    const selection = new Set(more ? state.selection : []);
    if (!more || !selection.delete(piece)) selection.add(piece);
    state.select(selection);
};

/** @param {import("./state.js").State} state @param {import("./actions.js").Actions} act */
export function piecesPanel(state, act) {
    const search = el("input", { type: "search", placeholder: "Search names", "aria-label": "Search pieces by name" });
    const count = el("span", { class: "quiet number" });
    let [column, descending] = ["area", true];
    const keys = /** @type {Record<string, (piece: number) => string | number>} */ ({
        name: (piece) => state.name(piece).toLowerCase(),
        class: (piece) => state.className(piece) || "\uffff",
        instance: (piece) => state.pieces.instance[piece],
        area: (piece) => state.pieces.areas_m2[piece],
    });
    const list = new PieceList("Pieces", "No piece has this name.", {
        row: (piece) => {
            const { semantic, instance, areas_m2 } = state.pieces;
            const area = areas_m2[piece];
            const label = `${state.name(piece)}, ${state.className(piece) || "no class"}, ${instance[piece] >= 1 ? `instance ${instance[piece]}` : "no instance"}, ${area.toPrecision(3)} m²`;
            return { piece, label, cells: [state.name(piece), classCell(state, semantic[piece]), instance[piece] >= 1 ? unseen("instance ", String(instance[piece])) : unseen("no instance", ""), unseen("", area >= 0.01 ? area.toFixed(2) : "<0.01", " m²")] };
        },
        isSelected: (piece) => state.selection.has(piece),
        select: selecting(state),
        open: (piece) => act.looking.goToPiece(piece),
    });
    const heads = Object.entries({ name: "Name", class: "Class", instance: "Inst.", area: "Area m²" }).map(([key, title]) =>
        el("button", { "data-column": key, title: `Sort by ${key}`, onclick: () => sort(key) }, title),
    );
    /** @param {string} key */
    function sort(key) {
        descending = column === key ? !descending : key === "area";
        column = key;
        refresh();
    }
    function refresh() {
        const found = [...Array(state.count).keys()].filter((piece) => !state.removed.has(piece) && matches(state.name(piece), search.value));
        const values = found.map((piece) => ({ piece, value: keys[column](piece) }));
        values.sort((a, b) => (a.value < b.value ? -1 : a.value > b.value ? 1 : a.piece - b.piece) * (descending ? -1 : 1));
        list.show(values.map(({ piece }) => piece));
        count.textContent = `${spaced(found.length)} of ${spaced(state.count - state.removed.size)}`;
    }
    search.addEventListener("input", refresh);
    search.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        if (event.key !== "Enter" && event.key !== "ArrowDown") return;
        event.preventDefault();
        list.begin();
    });
    const all = el("button", { title: "Select all pieces of this list", onclick: () => state.select(list.pieces) }, "Select all");
    state.on(["pieces"], refresh);
    state.on(["labels"], () => (column === "class" || column === "instance" ? refresh() : list.draw()));
    state.on(["selection"], () => {
        if (state.selection.size === 1) list.reveal([...state.selection][0]);
        list.draw();
    });
    const panel = el("div", {}, el("div", { class: "head" }, search, count, all), el("div", { class: "row-head", role: "group", "aria-label": "Sort by" }, ...heads), list.element);
    panel.addEventListener("shown", () => list.draw());
    return panel;
}
