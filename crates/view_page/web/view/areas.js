// How many pixels of a layer have each number, and the box around them.

/** @typedef {{ pixels: number, bounds: [number, number, number, number] }} Area of a number in a layer: its pixels and the box around them */

/** What was counted, by layer. @type {WeakMap<import("./numbers.js").LayerData, Map<number, Area>>} */
const counted = new WeakMap();

/** The area of each number of a whole layer with one number per pixel; `null` of others. @param {import("./numbers.js").LayerData | undefined} data */
export function areasIn(data) {
    if (!data || data.step !== 1 || data.shape[2] !== 1) return null;
    const known = counted.get(data);
    if (known) return known;
    /** @type {Map<number, Area>} */
    const areas = new Map();
    const [height, width] = data.shape;
    /** @type {Area | undefined} */
    let area;
    let last = NaN;
    for (let y = 0, i = 0; y < height; y++) {
        for (let x = 0; x < width; x++, i++) {
            const id = data.values[i];
            if (id !== last) {
                last = id;
                area = areas.get(id);
                if (!area) areas.set(id, (area = { pixels: 0, bounds: [x, y, x + 1, y + 1] }));
            }
            const { bounds } = /** @type {Area} */ (area);
            /** @type {Area} */ (area).pixels++;
            if (x < bounds[0]) bounds[0] = x;
            if (x >= bounds[2]) bounds[2] = x + 1;
            bounds[3] = y + 1;
        }
    }
    counted.set(data, areas);
    return areas;
}
