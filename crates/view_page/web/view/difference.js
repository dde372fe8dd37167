// The difference of two layers that hold numbers of the same kind: of one number per pixel with its sign, of several its length, and of
// ids whether they differ. It is a layer like any other, so it is coloured, read and measured like one.

import { PERCENTILES, fromHalf } from "./numbers.js";

/** @typedef {import("./numbers.js").LayerData} LayerData */
/** @typedef {import("./catalogue.js").LayerSpec} LayerSpec */

/** Percentiles are taken of this many pixels at most. */
const SAMPLED_PIXELS = 65536;

/** The number of each half-precision float. @type {Float32Array | null} */
let halves = null;

/** @type {WeakMap<LayerData, WeakMap<LayerData, LayerData>>} */
const known = new WeakMap();

/** Whether a difference of two layers means something. @param {LayerSpec} a @param {LayerSpec} b */
export const isAlike = (a, b) => a.channels === b.channels && a.unit === b.unit && (a.dtype[0] === "f") === (b.dtype[0] === "f") && (a.dtype[0] === "f" || a.like === b.like);

/**
 * The first layer minus the second; `null` where they are not of the same pixels or not here in full.
 * @param {LayerData} a
 * @param {LayerData} b
 * @returns {LayerData | null}
 */
export function differenceOf(a, b) {
    if (a.step !== 1 || b.step !== 1 || a.shape.some((side, i) => side !== b.shape[i])) return null;
    let ofFirst = known.get(a);
    if (!ofFirst) known.set(a, (ofFirst = new WeakMap()));
    let difference = ofFirst.get(b);
    if (!difference) ofFirst.set(b, (difference = subtract(a, b)));
    return difference;
}

/** @param {LayerData} a @param {LayerData} b @returns {LayerData} */
function subtract(a, b) {
    const [height, width, channels] = a.shape;
    const [x, y] = [reader(a), reader(b)];
    const isNumber = a.dtype.startsWith("float");
    const values = new Float32Array(height * width);
    for (let i = 0, at = 0; i < values.length; i++, at += channels) {
        if (!isNumber) values[i] = a.values[at] === b.values[at] ? 0 : 1;
        else if (channels === 1) values[i] = x(at) - y(at);
        else {
            let sum = 0;
            for (let c = 0; c < channels; c++) sum += (x(at + c) - y(at + c)) ** 2;
            values[i] = Math.sqrt(sum);
        }
    }
    return { shape: [height, width, 1], dtype: "float32", step: 1, size: a.size, values, summary: summaryOf(values, !isNumber ? "share that differs" : channels === 1 ? "difference" : "length of the difference") };
}

/** Reads the number at a place. @param {LayerData} data @returns {(at: number) => number} */
function reader({ values, dtype }) {
    if (dtype !== "float16") return (at) => values[at];
    halves ??= Float32Array.from({ length: 65536 }, (_, bits) => fromHalf(bits));
    const table = halves;
    return (at) => table[values[at]];
}

/** @param {Float32Array} values @param {string} of @returns {import("./numbers.js").Summary} */
function summaryOf(values, of) {
    let [low, high, sum, count] = [Infinity, -Infinity, 0, 0];
    const stride = Math.max(1, Math.ceil(values.length / SAMPLED_PIXELS));
    /** @type {number[]} */
    const sample = [];
    for (let i = 0; i < values.length; i++) {
        const value = values[i];
        if (!Number.isFinite(value)) continue;
        if (value < low) low = value;
        if (value > high) high = value;
        sum += value;
        count++;
        if (i % stride === 0) sample.push(value);
    }
    sample.sort((a, b) => a - b);
    const percentiles = sample.length ? PERCENTILES.map((percent) => sample[Math.round(((sample.length - 1) * percent) / 100)]) : [];
    return { of, range: count ? [low, high] : null, mean: count ? sum / count : null, percentiles, without: values.length - count };
}

/**
 * How a difference is coloured: about zero where it has a sign, and from zero on where it has none.
 * @param {LayerData} difference
 * @returns {{ map: string, range: [number, number] }}
 */
export function lookOfDifference({ summary }) {
    if (summary.of === "share that differs") return { map: "grey", range: [0, 1] };
    const { percentiles: p, range } = summary;
    const most = Math.max(Math.abs(p[0] ?? 0), Math.abs(p[6] ?? 0)) || Math.max(Math.abs(range?.[0] ?? 0), Math.abs(range?.[1] ?? 0)) || 1;
    return summary.of === "difference" ? { map: "balance", range: [-most, most] } : { map: "magma", range: [0, most] };
}
