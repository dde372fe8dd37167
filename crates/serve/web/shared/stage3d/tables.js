// Colours, flags and marks per piece and per face, as textures for the GPU programs.

import { DataTexture, RGBAFormat, RedIntegerFormat, UnsignedByteType, UnsignedIntType } from "../../vendor/three.js";
import { MARK_WIDTH, PIECE_WIDTH } from "./shaders.js";

/** How a piece is hatched; 0 is not at all. */
export const DARK_LINES = 1;
export const WHITE_LINES = 2;

/** What the colours' fourth value says of each. */
export const HATCHING = [255, 0, 128];

/**
 * A texture of integers, `width` in a row. Takes `values` as they are where they fill the rows, else a copy.
 *
 * @param {Uint8Array | Uint32Array} values
 * @param {number} width
 */
export function numbers(values, width) {
    const rows = Math.max(1, Math.ceil(values.length / width));
    let data = values;
    if (values.length !== rows * width) {
        data = values instanceof Uint8Array ? new Uint8Array(rows * width) : new Uint32Array(rows * width);
        data.set(values);
    }
    const small = data instanceof Uint8Array;
    const texture = new DataTexture(/** @type {any} */ (data), width, rows, RedIntegerFormat, small ? UnsignedByteType : UnsignedIntType);
    texture.internalFormat = small ? "R8UI" : "R32UI";
    texture.unpackAlignment = 1;
    texture.needsUpdate = true;
    return texture;
}

/** @param {Uint8Array} rgba @param {number} rows @param {number} [width] */
function colors(rgba, rows, width = PIECE_WIDTH) {
    const texture = new DataTexture(/** @type {any} */ (rgba), width, rows, RGBAFormat, UnsignedByteType);
    texture.needsUpdate = true;
    return texture;
}

/** Colour, flags and marks of every piece; marks of every face once they are asked for. Grows when pieces are added. */
export class Tables {
    /** @param {number} pieces */
    constructor(pieces) {
        this.rows = Math.max(1, Math.ceil(pieces / PIECE_WIDTH));
        const room = this.rows * PIECE_WIDTH;
        /** RGB per piece, sRGB 0..255, and one of {@link HATCHING}. */
        this.colors = new Uint8Array(room * 4).fill(255);
        this.flags = new Uint8Array(room);
        this.marks = new Uint8Array(room);
        this.colorTexture = colors(this.colors, this.rows);
        this.flagTexture = numbers(this.flags, PIECE_WIDTH);
        this.markTexture = numbers(this.marks, PIECE_WIDTH);
        this.noFaces = numbers(new Uint8Array(1), 1);
        this.noColors = colors(new Uint8Array(4), 1, 1);
        /** @type {DataTexture | null} */
        this.faceMarks = null;
        /** How faces look, where that is known. @type {DataTexture | null} */
        this.faceColors = null;
    }

    /**
     * Makes room for `pieces`, keeping what there is; new ones are white, without flags and marks.
     *
     * @param {number} pieces
     */
    grow(pieces) {
        if (pieces <= this.rows * PIECE_WIDTH) return;
        const larger = new Tables(pieces);
        larger.colors.set(this.colors);
        larger.flags.set(this.flags);
        larger.marks.set(this.marks);
        for (const texture of [this.colorTexture, this.flagTexture, this.markTexture]) texture.dispose();
        const { rows, colorTexture, flagTexture, markTexture } = larger;
        Object.assign(this, { rows, colors: larger.colors, flags: larger.flags, marks: larger.marks, colorTexture, flagTexture, markTexture });
    }

    /**
     * Marks these faces of the scene, and no other.
     *
     * @param {Iterable<number>} faces scene face numbers below `count`
     * @param {number} count above all face numbers
     */
    markFaces(faces, count) {
        if (this.faceMarks && /** @type {Uint8Array} */ (this.faceMarks.image.data).length < count) this.unmarkFaces();
        this.faceMarks ??= numbers(new Uint8Array(count), MARK_WIDTH);
        const data = /** @type {Uint8Array} */ (this.faceMarks.image.data);
        data.fill(0);
        for (const face of faces) data[face] = 1;
        this.faceMarks.needsUpdate = true;
    }

    /** Marks no face, and gives the memory back. */
    unmarkFaces() {
        this.faceMarks?.dispose();
        this.faceMarks = null;
    }

    /** How each face of the scene looks. @param {Uint8Array} rgb three values per face */
    setFaceColors(rgb) {
        const rows = Math.max(1, Math.ceil(rgb.length / 3 / MARK_WIDTH));
        const rgba = new Uint8Array(rows * MARK_WIDTH * 4);
        for (let i = 0, j = 0; i < rgb.length; i += 3, j += 4) rgba.set(rgb.subarray(i, i + 3), j);
        this.faceColors?.dispose();
        this.faceColors = colors(rgba, rows, MARK_WIDTH);
    }

    dispose() {
        for (const texture of [this.colorTexture, this.flagTexture, this.markTexture, this.noFaces, this.noColors, this.faceMarks, this.faceColors]) texture?.dispose();
    }
}
