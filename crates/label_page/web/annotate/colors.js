// Colours of pieces: by class, or by instance as in Hypersim's tool and the saved files. What has no label in the layer that is shown is
// hatched, so that it cannot be taken for a class of its colour: white without any label, grey with a label in the other layer, and in the
// colour of its class, with white lines, what is only suggested.

import { DARK_LINES, WHITE_LINES } from "../shared/stage3d/tables.js";

const UNLABELLED = [255, 255, 255];
const OTHER_LAYER = [77, 77, 77];

/**
 * Colours of all pieces, three values each, and how each is hatched.
 *
 * @param {import("./state.js").State} state
 */
export function pieceColors(state) {
    const { semantic, instance } = state.pieces;
    const rgb = new Uint8Array(state.count * 3);
    const hatched = new Uint8Array(state.count);
    for (let i = 0; i < state.count; i++) {
        const proposed = state.proposed.has(i) ? state.classById.get(state.suggestion(i)?.semantic ?? -1) : undefined;
        const color = proposed?.color ?? colorOf(state, semantic[i], instance[i]);
        rgb.set(color ?? (semantic[i] >= 1 || instance[i] >= 1 ? OTHER_LAYER : UNLABELLED), i * 3);
        hatched[i] = proposed ? WHITE_LINES : color === null ? DARK_LINES : 0;
    }
    return { rgb, hatched };
}

/** The colour of a label in the layer that is shown; null for none. @param {import("./state.js").State} state @param {number} semantic @param {number} instance @returns {ArrayLike<number> | null} */
function colorOf(state, semantic, instance) {
    if (state.layer === "instance") return instance >= 1 ? state.instanceColor(instance) : null;
    return state.classById.get(semantic)?.color ?? null;
}

/** As CSS. @param {ArrayLike<number>} rgb */
export const css = (rgb) => `rgb(${rgb[0]}, ${rgb[1]}, ${rgb[2]})`;

/** Black or white, whichever is better read on this colour: that which WCAG's contrast is higher with. @param {ArrayLike<number>} rgb */
export function textOn(rgb) {
    const linear = (/** @type {number} */ v) => (v <= 10 ? v / 3294 : ((v / 255 + 0.055) / 1.055) ** 2.4);
    return 0.2126 * linear(rgb[0]) + 0.7152 * linear(rgb[1]) + 0.0722 * linear(rgb[2]) > 0.179 ? "#000" : "#fff";
}
