// The box of the selection: the label that is given next, large; what is selected; and what can be done with it.

import { byId, el } from "../shared/dom.js";
import { oneTabStop } from "../shared/one_tab_stop.js";
import { css } from "./colors.js";
import { commandButton } from "./toolbar.js";

/** @typedef {import("./state.js").State} State */

/** The label that is given next, in words, and its colour where it has one. @param {State} state @returns {{ text: string, number: string, color: ArrayLike<number> | null }} */
export function labelToGive(state) {
    const bySemantic = state.layer === "semantic";
    if (state.erase) return { text: bySemantic ? "no class" : "no instance", number: "", color: null };
    if (bySemantic) {
        const one = state.currentClass === null ? null : state.classById.get(state.currentClass);
        if (one) return { text: one.name, number: String(one.id), color: one.color };
        return { text: "no class has this number", number: String(state.refused ?? ""), color: null };
    }
    if (state.unique) return { text: "a new instance each", number: "", color: null };
    if (state.fresh) return { text: "new instance", number: "", color: null };
    return { text: "instance", number: String(state.currentInstance), color: state.instanceColor(state.currentInstance) };
}

/** The large chip, and the digits that are being typed, over the view. @param {State} state @param {import("./digits.js").Digits} digits */
function labelChip(state, digits) {
    const chip = el("div", { id: "label-now" });
    const over = byId("typed");
    state.on(["tools", "labels", "typed"], () => {
        const { text, number, color } = labelToGive(state);
        const swatch = el("span", { class: "swatch" });
        if (color) swatch.style.background = css(color);
        else swatch.classList.add("hatched");
        const typing = digits.typed !== "";
        chip.replaceChildren(swatch, el("b", { class: "number" }, typing ? `${digits.typed}_` : number), el("span", { class: "name" }, typing ? digits.meaning : text));
        chip.classList.toggle("wrong", state.layer === "semantic" && !state.erase && state.currentClass === null);
        over.hidden = !typing;
        over.replaceChildren(...[...chip.children].map((child) => child.cloneNode(true)));
        over.classList.toggle("wrong", chip.classList.contains("wrong"));
    });
    return chip;
}

/** What the selection is called, and what it has. @param {State} state @returns {[string, string]} */
function words(state) {
    const pieces = [...state.selection];
    if (pieces.length === 0) return ["Nothing selected", "Click a piece, or press . for the next unlabelled"];
    const { areas_m2, instance, materials } = state.pieces;
    const area = `${pieces.reduce((sum, piece) => sum + areas_m2[piece], 0).toFixed(2)} m²`;
    const [first] = pieces;
    if (pieces.length > 1) return [`${pieces.length} pieces`, [...new Set(pieces.map((piece) => state.className(piece) || "no class"))].slice(0, 4).join(", ") + `, ${area}`];
    return [state.name(first), [state.className(first) || "no class", instance[first] >= 1 ? `instance ${instance[first]}` : "no instance", area, materials[first], state.reviewOf(first)].filter(Boolean).join(", ")];
}

/** @param {State} state @param {Map<string, import("./commands.js").Command>} table @param {import("./actions.js").Actions} act */
export function selectionBox(state, table, act) {
    const what = el("div", { class: "what" });
    const more = el("div", { class: "what quiet" });
    const button = (/** @type {string} */ id, /** @type {string} */ text) => commandButton(state, table, id, text);
    const give = button("assign", "Give label");
    give.classList.add("primary");
    const confirm = button("confirm", "Confirm");
    const again = button("same-again", "Again");
    const label = [give, button("thing", "New thing"), confirm];
    const choose = [["whole", "Whole"], ["same-name", "Same name"], ["same-geometry", "Same shape"], ["split-component", "Split"], ["split-faces", "Paint"]].map(([id, text]) => button(id, text));
    const rows = el("div", { class: "rows" }, el("div", { class: "row" }, ...label, again), el("div", { class: "row" }, ...choose));
    byId("current").append(labelChip(state, act.digits), what, more, rows);
    state.on(["selection", "labels", "pieces", "reviews"], () => {
        const [name, has] = words(state);
        for (const [line, text] of [[what, name], [more, has]]) [line.textContent, line.title] = [text, text];
        for (const made of [...label, ...choose]) made.disabled = state.selection.size === 0;
        const [first] = state.selection;
        const suggested = state.selection.size > 0 ? state.classById.get(state.suggestion(first)?.semantic ?? -1) : undefined;
        confirm.textContent = suggested ? `Confirm ${suggested.name}` : "Confirm";
        confirm.disabled ||= !suggested;
    });
    oneTabStop(rows);
}
