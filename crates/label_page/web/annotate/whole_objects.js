// The objects that a scene is grouped into: by the groups of its file, else by the beginnings of names.

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
