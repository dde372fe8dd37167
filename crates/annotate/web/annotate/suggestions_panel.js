// The panel "Suggested": classes proposed from names, to confirm one by one, or all above a confidence.

import { el, spaced } from "../shared/dom.js";
import { PieceList } from "./list.js";
import { classCell, selecting } from "./pieces_panel.js";

/** @param {import("./state.js").State} state @param {import("./actions.js").Actions} act */
export function suggestionsPanel(state, act) {
    const slider = el("input", { type: "range", min: "0", max: "1", step: "0.01", value: "0.9", "aria-label": "Minimum confidence" });
    const threshold = el("output", { class: "number" });
    const confirm = el("button", { class: "primary", id: "confirm-all", onclick: () => void act.confirm(list.pieces) });
    const list = new PieceList("Suggestions", "Nothing without a class is suggested with this confidence.", {
        row: (piece) => {
            const { semantic, confidence, reason } = state.pieces.suggestions[piece];
            const name = state.classById.get(semantic)?.name ?? "";
            const yes = el("button", { class: "plain", tabindex: "-1", "aria-label": `Confirm ${name} for ${state.name(piece)}`, onclick: (/** @type {Event} */ event) => confirmOne(event, piece) }, "✓");
            return { piece, label: `${state.name(piece)}: ${name}, ${Math.round(confidence * 100)} %${reason ? `, ${reason}` : ""}`, cells: [state.name(piece), classCell(state, semantic), `${Math.round(confidence * 100)} %`, yes] };
        },
        isSelected: (piece) => state.selection.has(piece),
        select: selecting(state),
        open: (piece) => act.goToPiece(piece),
    });
    /** @param {Event} event @param {number} piece */
    function confirmOne(event, piece) {
        event.stopPropagation();
        void act.confirm([piece]);
    }
    function refresh() {
        const { suggestions, semantic } = state.pieces;
        const min = Number(slider.value);
        const open = [...Array(state.count).keys()].filter((piece) => !state.removed.has(piece) && suggestions[piece] && suggestions[piece].confidence >= min && semantic[piece] < 1);
        list.show(open.sort((a, b) => suggestions[b].confidence - suggestions[a].confidence || a - b));
        threshold.textContent = `≥ ${Math.round(min * 100)} %`;
        confirm.textContent = `Confirm ${spaced(open.length)}`;
        confirm.disabled = open.length === 0;
    }
    slider.addEventListener("input", refresh);
    state.on(["labels", "pieces"], refresh);
    state.on(["selection"], () => list.draw());
    const note = el("p", { class: "quiet words" }, state.scene.has_suggestions ? "Learned from names of parts and materials. Y confirms the selection; a wrong one is corrected by giving another class." : "No name of this scene is known, so there is nothing to suggest.");
    const panel = el("div", {}, el("div", { class: "head" }, slider, threshold, confirm), list.element, note);
    panel.addEventListener("shown", () => list.draw());
    return panel;
}
