// How large a scene is to look at: with the things in it, and without the ground or sky around them.

/** A piece is ground or sky if it is so many times as large as everything smaller together. */
const FAR_LARGER = 4;
/** Of so many pieces the smaller half is always in sight. */
const KEPT_SHARE = 0.5;

/**
 * The box around what a view of the whole scene is to show.
 *
 * @param {import("./state.js").State} state
 * @returns {{ min: number[], max: number[] }} metres
 */
export function extentToShow(state) {
    const { mins, maxs, faces } = state.pieces;
    const axes = [0, 1, 2];
    const size = (/** @type {number[]} */ min, /** @type {number[]} */ max) => Math.hypot(...axes.map((axis) => max[axis] - min[axis]));
    const pieces = [...Array(state.count).keys()].filter((piece) => !state.removed.has(piece) && faces[piece] > 0);
    pieces.sort((a, b) => size(mins[a], maxs[a]) - size(mins[b], maxs[b]));
    /** @type {{ min: number[], max: number[] } | null} */
    let box = null;
    for (const [i, piece] of pieces.entries()) {
        if (box && i >= KEPT_SHARE * pieces.length && size(mins[piece], maxs[piece]) > FAR_LARGER * size(box.min, box.max)) return box;
        box = { min: axes.map((axis) => Math.min(mins[piece][axis], box?.min[axis] ?? Infinity)), max: axes.map((axis) => Math.max(maxs[piece][axis], box?.max[axis] ?? -Infinity)) };
    }
    return box ?? state.scene.bounds;
}
