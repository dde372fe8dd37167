// Colours for numbers: perceptually uniform maps for quantities, a table of distinct colours for ids, and the colours of masks.

/** Maps at tenths, sRGB, from matplotlib (CC0): equal steps of the value look like equal steps of lightness. `balance` is our own, for numbers with a sign. @type {Record<string, string[]>} */
const TENTHS = {
    viridis: ["440154", "482475", "414487", "355f8d", "2a788e", "21918c", "22a884", "44bf70", "7ad151", "bddf26", "fde725"],
    magma: ["000004", "150e37", "3b0f70", "641a80", "8c2981", "b63679", "de4968", "f76f5c", "fe9f6d", "fece91", "fcfdbf"],
    inferno: ["000004", "160b39", "420a68", "6a176e", "932667", "bc3754", "dd513a", "f37819", "fca50a", "f6d746", "fcffa4"],
    balance: ["1b3f8b", "2f62b0", "5b8bc9", "8fb2dc", "c3d5e8", "ebebeb", "efc9bd", "e39f8b", "d0705d", "b8433a", "8f1d22"],
    grey: ["000000", "1a1a1a", "333333", "4d4d4d", "666666", "808080", "999999", "b3b3b3", "cccccc", "e6e6e6", "ffffff"],
};

/** Names of the maps. */
export const MAPS = Object.keys(TENTHS);

/** @param {string} hex @returns {number[]} */
const rgbOf = (hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));

/**
 * 256 colours of a map, four bytes each.
 * @param {string} name
 */
export function mapTable(name) {
    const tenths = (TENTHS[name] ?? TENTHS.viridis).map(rgbOf);
    const table = new Uint8Array(1024);
    for (let i = 0; i < 256; i++) {
        const place = (i / 255) * 10;
        const below = Math.min(9, Math.floor(place));
        for (let c = 0; c < 3; c++) table[4 * i + c] = Math.round(tenths[below][c] + (tenths[below + 1][c] - tenths[below][c]) * (place - below));
        table[4 * i + 3] = 255;
    }
    return table;
}

/**
 * @param {number} hue on [0,1)
 * @param {number} saturation
 * @param {number} value
 */
function hsv(hue, saturation, value) {
    return [5, 3, 1].map((n) => {
        const k = (n + 6 * hue) % 6;
        return Math.round(255 * (value - value * saturation * Math.max(0, Math.min(k, 4 - k, 1))));
    });
}

/** The colour of a part's or material's number, as in the dataset's previews; black below 1. @param {number} id */
export function idColor(id) {
    if (id < 1) return [0, 0, 0];
    const value = [0.95, 0.72, 0.84][id % 3];
    const saturation = [0.62, 0.78, 0.46][Math.floor(id / 3) % 3];
    return hsv((id * 0.6180339887498949) % 1, saturation, value);
}

/** Codes of `valid`, in words. */
export const VALIDITY = [
    { code: 0, name: "nothing hit", color: [0, 0, 0] },
    { code: 1, name: "valid", color: [102, 168, 106] },
    { code: 2, name: "color saturated at 65504", color: [222, 74, 60] },
    { code: 3, name: "no diffuse reflectance", color: [70, 118, 190] },
];

/** Bits of `surface_traits`, in words, the one that decides the colour first. */
export const TRAITS = [
    { bit: 4, name: "emitter", color: [230, 190, 60] },
    { bit: 2, name: "glass", color: [60, 170, 180] },
    { bit: 1, name: "mirror", color: [60, 90, 190] },
    { bit: 16, name: "back of a one-sided surface", color: [190, 60, 160] },
    { bit: 32, name: "moves by itself", color: [230, 120, 50] },
    { bit: 8, name: "shows more than one part", color: [172, 172, 172] },
];

/** @param {number} bits */
export function traitsColor(bits) {
    const base = TRAITS.find((trait) => trait.bit !== 8 && bits & trait.bit)?.color ?? [90, 90, 90];
    return bits & 8 ? base.map((v) => Math.floor(v / 2) + 127) : base;
}

/** Codes of the other masks. @type {Record<string, { code: number, name: string, color: number[] }[]>} */
export const MASKS = {
    valid: VALIDITY,
    occlusion_boundary: [
        { code: 0, name: "no jump in depth", color: [28, 30, 34] },
        { code: 1, name: "near side of a jump", color: [240, 190, 90] },
        { code: 2, name: "far side of a jump", color: [80, 130, 210] },
    ],
    surface_side: [
        { code: 0, name: "no surface", color: [28, 30, 34] },
        { code: 1, name: "front", color: [102, 168, 106] },
        { code: 2, name: "back", color: [190, 60, 160] },
    ],
    pair_visibility: [
        { code: 0, name: "hidden or outside in that frame", color: [50, 54, 62] },
        { code: 1, name: "seen in that frame", color: [102, 168, 106] },
    ],
    flow_visibility: [
        { code: 0, name: "hidden or outside in the next frame", color: [50, 54, 62] },
        { code: 1, name: "seen in the next frame", color: [102, 168, 106] },
    ],
};

/** @param {number[]} rgb */
export const cssColor = ([r, g, b]) => `rgb(${r} ${g} ${b})`;

/**
 * Colours by number, four bytes each, from number −1 on: place i is number i − 1. 65536 places fill a texture of 256 × 256.
 * @param {(id: number) => number[]} color
 * @param {number} count
 */
export function idTable(color, count) {
    const table = new Uint8Array(4 * 65536);
    for (let id = 0; id < Math.min(count, 65535); id++) table.set([...color(id), 255], 4 * (id + 1));
    table[3] = 255;
    return table;
}
