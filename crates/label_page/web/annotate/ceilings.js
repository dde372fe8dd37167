// What covers rooms from above: by its class, by what is suggested for it, by its name, or by its shape and height.

const NAMES = /ceiling|roof/i;
/** A ceiling is flatter than this share of its smaller side … */
const FLAT = 0.1;
/** … no smaller than this, metres … */
const SMALLEST_M = 0.8;
/** … and above this share of the scene's height. */
const HIGH = 0.7;

/** @param {import("./state.js").State} state @returns {number[]} pieces */
export function ceilings(state) {
    const { semantic, mins, maxs } = state.pieces;
    const { min, max } = state.scene.bounds;
    const high = min[2] + HIGH * (max[2] - min[2]);
    const isFlatAndHigh = (/** @type {number} */ piece) => {
        const [x, y, z] = [0, 1, 2].map((axis) => maxs[piece][axis] - mins[piece][axis]);
        const side = Math.min(x, y);
        return mins[piece][2] > high && side > SMALLEST_M && z < FLAT * side;
    };
    const isCeiling = (/** @type {number} */ piece) => {
        const known = semantic[piece] >= 1 ? semantic[piece] : state.suggestion(piece)?.semantic;
        const name = state.classById.get(known ?? -1)?.name ?? "";
        return NAMES.test(name) || (semantic[piece] < 1 && (NAMES.test(state.name(piece)) || isFlatAndHigh(piece)));
    };
    return [...Array(state.count).keys()].filter((piece) => !state.removed.has(piece) && isCeiling(piece));
}
