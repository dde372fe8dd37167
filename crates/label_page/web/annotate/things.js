// Whole things: the object that the selection is of, by the groups of the scene; and its moved copies.

import { toast } from "../shared/toast.js";

/**
 * The pieces of the object that pieces are of, by the groups around them; where they are all of it, of the group around that. Null where
 * there is none, or only one that is the whole scene.
 *
 * @param {import("./state.js").State} state
 * @param {Iterable<number>} pieces
 * @returns {number[] | null}
 */
export function wholeOf(state, pieces) {
    const { objects } = state.pieces;
    const paths = [...pieces].map((piece) => objects[piece].split("/"));
    if (paths.length === 0) return null;
    let length = Math.min(...paths.map((path) => path.length));
    while (length > 0 && paths.some((path) => path.slice(0, length).join("/") !== paths[0].slice(0, length).join("/"))) length--;
    const there = [...Array(state.count).keys()].filter((piece) => !state.removed.has(piece));
    for (; length > 0; length--) {
        const object = paths[0].slice(0, length).join("/");
        const found = object === "" ? [] : there.filter((piece) => objects[piece] === object || objects[piece].startsWith(`${object}/`));
        if (found.length === there.length) return null;
        if (found.length > paths.length) return found;
    }
    return null;
}

export class Things {
    /** @param {import("./actions.js").Actions} act */
    constructor(act) {
        this.act = act;
        /** Pieces that were labelled last. @type {number[]} */
        this.last = [];
    }

    /** Selects the object around the selection; false where there is none, which the user is told. */
    selectWhole() {
        const pieces = this.act.chosen();
        if (!pieces) return false;
        const whole = wholeOf(this.act.state, pieces);
        if (whole) this.act.state.select(whole);
        else toast("The scene has no larger object around the selection.", "Add pieces by Ctrl+click, or select by name or shape.");
        return whole !== null;
    }

    /** Makes the object around the selection one thing; where there is none around it, the selection. */
    async makeWhole() {
        const { state } = this.act;
        const whole = wholeOf(state, state.selection);
        if (whole) state.select(whole);
        await this.act.makeThing();
    }

    /** Labels the moved copies of the selection, or of what was labelled last where the selection has no label yet. */
    async sameAgain() {
        const { act } = this;
        const isLabelled = (/** @type {number} */ piece) => act.sent.has(piece) || act.state.pieces.semantic[piece] >= 1;
        const selected = [...act.state.selection];
        const pieces = selected.length > 0 && selected.every(isLabelled) ? selected : this.last;
        if (pieces.length === 0) return toast("Nothing was labelled yet.", "Label a thing; then its copies get the same.");
        const change = await act.edits.send({ type: "same_again", pieces });
        if (change?.pieces.length > 0) toast(`${change.description}.`, "Ctrl+Z takes it back.", "good");
    }
}
