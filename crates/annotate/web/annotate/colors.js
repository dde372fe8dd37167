// Colours of pieces: by class, or by instance as Hypersim's tool makes them. White is unlabelled; grey is labelled in the other layer only.

const UNLABELLED = [255, 255, 255];
const OTHER_LAYER = [77, 77, 77];
const GOLDEN_DEG = 137.508;

/**
 * The colour of an instance: neighbours in number are far apart in hue; the first is paler, as the original's is.
 *
 * @param {number} instance from 1
 * @returns {[number, number, number]}
 */
export function instanceColor(instance) {
    const hue = (instance * GOLDEN_DEG) % 360;
    const [s, v] = instance === 1 ? [0.8, 1] : [1, 0.8];
    /** @param {number} n */
    const channel = (n) => {
        const k = (n + hue / 60) % 6;
        return Math.round(255 * (v - v * s * Math.max(0, Math.min(k, 4 - k, 1))));
    };
    return [channel(5), channel(3), channel(1)];
}

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

/** @param {import("./state.js").State} state @param {number} semantic @param {number} instance @returns {number[]} */
function colorOf(state, semantic, instance) {
    const bySemantic = state.layer === "semantic";
    if (bySemantic && semantic >= 1) return state.classById.get(semantic)?.color ?? UNLABELLED;
    if (!bySemantic && instance >= 1) return instanceColor(instance);
    return semantic >= 1 || instance >= 1 ? OTHER_LAYER : UNLABELLED;
}

/** As CSS. @param {ArrayLike<number>} rgb */
export const css = (rgb) => `rgb(${rgb[0]}, ${rgb[1]}, ${rgb[2]})`;
