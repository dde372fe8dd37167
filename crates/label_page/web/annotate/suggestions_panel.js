// The panel "Suggested": classes proposed from names, to confirm or reject: all of a class at once, or the groups of one name that it has. While
// the panel is open the scene shows them, hatched, in the colours of their classes.

import { el, spaced } from "../shared/dom.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { PieceList } from "./list.js";
import { stem } from "./names.js";
import { classCell } from "./pieces_panel.js";
import { groups, rowsOf } from "./suggestion_groups.js";

/** @param {import("./state.js").State} state @param {import("./actions.js").Actions} act */
export function suggestionsPanel(state, act) {
    const slider = el("input", { type: "range", min: "0", max: "1", step: "0.01", value: "0.9", "aria-label": "Minimum confidence" });
    const threshold = el("output", { class: "number" });
    const all = () => [...new Set([...rows.values()].flat())];
    const confirm = el("button", { id: "confirm-all", onclick: () => void act.confirm(all()) });
    /** @type {Map<number, number[]>} */
    let rows = new Map();
    const of = (/** @type {number} */ row) => rows.get(row) ?? [];
    const list = new PieceList("Suggestions", "Nothing without a class is suggested with this confidence.", {
        row: (first) => suggestionRow(state, act, first, of(first)),
        isSelected: (first) => of(first).every((piece) => state.selection.has(piece)),
        select: (first, more) => state.select([...(more ? state.selection : []), ...of(first)]),
        open: (first) => void act.looking.lookAt(of(first)),
    });
    function refresh() {
        const least = Number(slider.value);
        rows = rowsOf(state, groups(state, least));
        list.show([...rows.keys()]);
        const count = all().length;
        threshold.textContent = `≥ ${Math.round(least * 100)} %`;
        confirm.textContent = `Confirm all ${spaced(count)}`;
        confirm.disabled = count === 0;
        if (!panel.hidden) propose();
    }
    const propose = () => state.set({ proposed: new Set(all()) });
    slider.addEventListener("input", refresh);
    const selected = (/** @type {string} */ id, /** @type {string} */ text, /** @type {() => void} */ run) => el("button", { id, disabled: true, onclick: run }, text);
    const judge = [selected("confirm-selected", "✓ Confirm selected", () => act.confirmSelection()), selected("reject-selected", "✗ Reject selected", () => act.withSelection((pieces) => state.reject(pieces)))];
    const buttons = el("div", { class: "review", role: "group", "aria-label": "Suggestions for the selection" }, ...judge);
    oneTabStop(buttons);
    const note = el("p", { class: "quiet words" }, state.scene.has_suggestions ? "Learned from names of parts and materials. Y confirms and Shift+Y rejects what is selected." : "The names of this scene are unknown, so there are no suggestions.");
    const panel = el("div", { class: "suggested" }, el("div", { class: "head" }, slider, threshold, confirm), list.element, buttons, note);
    panel.addEventListener("shown", () => {
        list.draw();
        propose();
    });
    panel.addEventListener("left", () => state.set({ proposed: new Set() }));
    state.on(["labels", "pieces"], refresh);
    state.on(["selection", "labels"], () => {
        list.draw();
        for (const button of judge) button.disabled = ![...state.selection].some((piece) => state.suggestion(piece) && state.pieces.semantic[piece] < 1);
    });
    return panel;
}

/** @param {import("./state.js").State} state @param {import("./actions.js").Actions} act @param {number} row @param {number[]} pieces */
function suggestionRow(state, act, row, pieces) {
    const [first] = pieces;
    const semantic = state.suggestion(first)?.semantic ?? -1;
    const className = state.classById.get(semantic)?.name ?? "";
    const name = row < 0 ? `all ${pieces.length} of this class` : pieces.length === 1 ? state.name(first) : `${stem(state.name(first))} × ${pieces.length}`;
    const sure = Math.round(100 * Math.min(...pieces.map((piece) => state.suggestion(piece)?.confidence ?? 0)));
    const button = (/** @type {string} */ sign, /** @type {string} */ verb, /** @type {() => void} */ run) => {
        const pressed = (/** @type {Event} */ event) => {
            event.stopPropagation();
            run();
        };
        // For the pointer; keys have the buttons below the list.
        return el("span", { class: "judge", "aria-hidden": "true", "data-judge": verb, title: `${verb} ${className} for ${name}`, onclick: pressed, ondblclick: (/** @type {Event} */ event) => event.stopPropagation() }, sign);
    };
    const buttons = el("span", {}, button("✓", "Confirm", () => void act.confirm(pieces)), button("✗", "Reject", () => state.reject(pieces)));
    return { piece: row, label: `${name}: ${className}, ${sure} %`, cells: [row < 0 ? el("b", {}, name) : name, classCell(state, semantic), `${sure} %`, buttons] };
}
