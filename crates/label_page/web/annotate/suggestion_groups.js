// Suggestions in groups: of one name and class, and the groups of each class.

import { stem } from "./names.js";

/**
 * Open suggestions of at least this confidence, in groups of one name and class; the surest first.
 *
 * @param {import("./state.js").State} state
 * @param {number} least
 * @returns {number[][]} pieces
 */
export function groups(state, least) {
    /** @type {Map<string, number[]>} */
    const found = new Map();
    for (let piece = 0; piece < state.count; piece++) {
        const suggestion = state.suggestion(piece);
        if (!suggestion || suggestion.confidence < least || state.pieces.semantic[piece] >= 1 || state.removed.has(piece)) continue;
        const key = `${suggestion.semantic} ${stem(state.name(piece))}`;
        found.set(key, [...(found.get(key) ?? []), piece]);
    }
    const sure = (/** @type {number[]} */ pieces) => Math.min(...pieces.map((piece) => state.suggestion(piece)?.confidence ?? 0));
    return [...found.values()].sort((a, b) => sure(b) - sure(a) || b.length - a.length || a[0] - b[0]);
}

/**
 * The rows of the list: each class, the one with most pieces first, and below it its groups, where there are several. A row of a class has
 * the negative number of the class, one of a group the number of its first piece.
 *
 * @param {import("./state.js").State} state
 * @param {number[][]} groups
 * @returns {Map<number, number[]>} the pieces of each row
 */
export function rowsOf(state, groups) {
    /** @type {Map<number, number[][]>} */
    const byClass = new Map();
    for (const pieces of groups) {
        const semantic = state.suggestion(pieces[0])?.semantic ?? -1;
        byClass.set(semantic, [...(byClass.get(semantic) ?? []), pieces]);
    }
    const sorted = [...byClass].sort(([, a], [, b]) => b.flat().length - a.flat().length);
    return new Map(sorted.flatMap(([semantic, all]) => [...(all.length > 1 ? [/** @type {[number, number[]]} */ ([-semantic, all.flat()])] : []), ...all.map((pieces) => /** @type {[number, number[]]} */ ([pieces[0], pieces]))]));
}
