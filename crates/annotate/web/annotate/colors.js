// Colours of pieces: by class, or by instance as in Hypersim's tool and the saved files. White is unlabelled; grey is labelled in the other
// layer only.

const UNLABELLED = [255, 255, 255];
const OTHER_LAYER = [77, 77, 77];

/**
 * Colours of all pieces, three values each.
 *
 * @param {import("./state.js").State} state
 */
export function pieceColors(state) {
    const { semantic, instance } = state.pieces;
    const rgb = new Uint8Array(state.count * 3);
    for (let i = 0; i < state.count; i++) rgb.set(colorOf(state, semantic[i], instance[i]), i * 3);
    return rgb;
}

/** @param {import("./state.js").State} state @param {number} semantic @param {number} instance @returns {ArrayLike<number>} */
function colorOf(state, semantic, instance) {
    const bySemantic = state.layer === "semantic";
    if (bySemantic && semantic >= 1) return state.classById.get(semantic)?.color ?? UNLABELLED;
    if (!bySemantic && instance >= 1) return state.instanceColor(instance);
    return semantic >= 1 || instance >= 1 ? OTHER_LAYER : UNLABELLED;
}

/** As CSS. @param {ArrayLike<number>} rgb */
export const css = (rgb) => `rgb(${rgb[0]}, ${rgb[1]}, ${rgb[2]})`;
