// Whole things: the object that the selection is of, by the groups of the scene; and its copies.

import { toast } from "../shared/toast.js";
import { wholeOf } from "./whole_objects.js";

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

    /** Labels the copies of the selection, moved or mirrored, or of what was labelled last where the selection has no label yet. */
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
