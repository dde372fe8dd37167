// The rooms of a scene, by its floors: a room is what stands on one, up to the floor above.

/** A floor is flatter than this share of its smaller side … */
const FLAT = 0.1;
/** … and no smaller than this, metres. */
const SMALLEST_M = 1;
/** A floor so much higher is one of another storey, metres. */
const STOREY_M = 1.5;
/** The inner sides of walls stand where a floor ends: so much farther out they are in the box, metres. */
const WALL_M = 0.02;

/** @typedef {{ name: string, min: number[], max: number[] }} Room a box along the axes, metres */

/**
 * The rooms that can be told apart; none where there are not at least two floors.
 *
 * @param {import("./state.js").State} state
 * @returns {Room[]}
 */
export function rooms(state) {
    const { mins, maxs, semantic } = state.pieces;
    const isFloor = (/** @type {number} */ piece) => {
        const [x, y, z] = [0, 1, 2].map((axis) => maxs[piece][axis] - mins[piece][axis]);
        const side = Math.min(x, y);
        const isNamed = semantic[piece] >= 1 ? state.classById.get(semantic[piece])?.name === "floor" : /floor/i.test(state.name(piece));
        return isNamed && side > SMALLEST_M && z < FLAT * side;
    };
    const floors = [...Array(state.count).keys()].filter(isFloor);
    /** @type {Map<string, Room>} */
    const byName = new Map();
    for (const floor of floors) {
        const name = roomName(state.name(floor));
        const known = byName.get(name);
        byName.set(name, { name, min: mins[floor].map((/** @type {number} */ v, /** @type {number} */ i) => Math.min(v, known?.min[i] ?? v)), max: maxs[floor].map((/** @type {number} */ v, /** @type {number} */ i) => Math.max(v, known?.max[i] ?? v)) });
    }
    const all = [...byName.values()];
    if (all.length < 2) return [];
    const meets = (/** @type {Room} */ a, /** @type {Room} */ b) => [0, 1].every((axis) => a.min[axis] < b.max[axis] && b.min[axis] < a.max[axis]);
    return all.map((room) => {
        const { name, min, max } = room;
        const above = all.filter((other) => other.min[2] > min[2] + STOREY_M && meets(room, other)).map((other) => other.min[2]);
        const top = Math.min(state.scene.bounds.max[2], ...above);
        return { name, min: min.map((v) => v - WALL_M), max: [max[0] + WALL_M, max[1] + WALL_M, top] };
    });
}

/** What a floor's name says of its room: `floor_living_room/boards` is of the living room. @param {string} name */
function roomName(name) {
    const words = name.split("/")[0].replace(/floor(ing)?/gi, " ").replace(/[_\-.\s]+/g, " ").trim();
    return /[^\d]/.test(words) ? words : `room ${words || name}`;
}
