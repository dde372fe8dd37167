// Stored numbers: reading them from buffers, and writing them for people, exactly or in short.

/** @typedef {{ shape: [number, number, number], dtype: string, summary: Summary, values: Uint8Array | Int16Array | Uint16Array | Float32Array, step: number, size: [number, number] }} LayerData */
/** @typedef {{ of: string, range: [number, number] | null, mean: number | null, percentiles: number[], without: number, tone_scale?: number }} Summary */

/** Percentiles that a summary has, of 100. */
export const PERCENTILES = [1, 5, 25, 50, 75, 95, 99];

/** @param {number} bits of a half-precision float */
export function fromHalf(bits) {
    const sign = bits & 0x8000 ? -1 : 1;
    const exponent = (bits >> 10) & 0x1f;
    const fraction = bits & 0x3ff;
    if (exponent === 0) return sign * 2 ** -24 * fraction;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * 2 ** (exponent - 25) * (1024 + fraction);
}

/**
 * The array that a layer's bytes are; halves stay bits.
 * @param {string} dtype
 * @param {ArrayBuffer} bytes
 */
export function valuesOf(dtype, bytes) {
    switch (dtype) {
        case "float16": return new Uint16Array(bytes);
        case "float32": return new Float32Array(bytes);
        case "int16": return new Int16Array(bytes);
        default: return new Uint8Array(bytes);
    }
}

/**
 * The numbers of a pixel of a whole layer, exactly as stored; `null` outside of the picture.
 * @param {LayerData} data
 * @param {number} x
 * @param {number} y
 * @returns {number[] | null}
 */
export function pixelOf(data, x, y) {
    const [height, width, channels] = data.shape;
    const column = Math.floor(x / data.step), row = Math.floor(y / data.step);
    if (column < 0 || row < 0 || column >= width || row >= height) return null;
    const at = (row * width + column) * channels;
    const values = [...data.values.slice(at, at + channels)];
    return data.dtype === "float16" ? values.map(fromHalf) : values;
}

/**
 * The shortest decimal number that is read back as the stored one.
 * @param {number} value
 * @param {string} dtype
 */
export function exact(value, dtype) {
    if (!Number.isFinite(value)) return Number.isNaN(value) ? "NaN" : value > 0 ? "∞" : "−∞";
    if (dtype === "int16" || dtype === "uint8" || value === 0) return String(value);
    const digits = dtype === "float16" ? 5 : 9;
    const same = dtype === "float16" ? (/** @type {number} */ v) => toHalfBits(v) === toHalfBits(value) : (/** @type {number} */ v) => Math.fround(v) === value;
    for (let n = 1; n < digits; n++) {
        const text = value.toPrecision(n);
        if (same(Number(text))) return tidy(text);
    }
    return tidy(value.toPrecision(digits));
}

/** @param {string} text of toPrecision */
const tidy = (text) => (Math.abs(Number(text)) >= 1e-4 && Math.abs(Number(text)) < 1e7 ? String(Number(text)) : Number(text).toExponential());

/** The nearest half-precision float. @param {number} value */
function toHalfBits(value) {
    const magnitude = Math.abs(value);
    if (magnitude < 2 ** -14) return Math.round(magnitude * 2 ** 24);
    const exponent = Math.floor(Math.log2(magnitude));
    return Math.round((exponent + 14) * 1024 + (magnitude / 2 ** exponent) * 1024);
}

/** Three or four digits: for legends and tables. @param {number | null | undefined} value */
export function brief(value) {
    if (value === null || value === undefined || Number.isNaN(value)) return "–";
    if (value === 0) return "0";
    const magnitude = Math.abs(value);
    if (magnitude >= 1e5 || magnitude < 1e-3) return value.toExponential(1);
    return String(Number(value.toPrecision(magnitude >= 1000 ? 4 : 3)));
}

/** @param {number} share of 1 */
export const percent = (share) => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`;
