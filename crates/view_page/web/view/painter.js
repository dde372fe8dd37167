// Draws layers with WebGL 2: arrays are uploaded as they are stored and coloured on the graphics card.

import { KINDS, VERTEX, fragment } from "./shaders.js";

/** @typedef {import("./numbers.js").LayerData} LayerData */
/** @typedef {{ x: number, y: number, width: number, height: number }} Rect in device pixels, from the upper left */
/**
 * What is drawn: a layer with its look.
 * @typedef {{ data: LayerData, kind: import("./kinds.js").Kind, table: Uint8Array | null, range: [number, number], logarithm: boolean, exposure: number, tone: number, ids: LayerData | null, marked: number, alone: boolean, accent: number[] }} Picture
 */
/** Where the picture lies: its upper left corner in device pixels, and device pixels per pixel. @typedef {{ x: number, y: number, zoom: number }} Placement */

/** Memory that textures may take on the graphics card, bytes. */
const MAX_BYTES = 512 * 2 ** 20;

/** @type {Record<string, [internal: number[], format: number[], type: number, sampler: "sampler2D" | "isampler2D" | "usampler2D"]>} */
const FORMATS = {
    float16: [[0x822d, 0x822f, 0x881b], [0x1903, 0x8227, 0x1907], 0x140b, "sampler2D"], // R16F RG16F RGB16F; RED RG RGB; HALF_FLOAT
    float32: [[0x822e, 0x8230, 0x8815], [0x1903, 0x8227, 0x1907], 0x1406, "sampler2D"], // R32F RG32F RGB32F; FLOAT
    int16: [[0x8233, 0x8239, 0x8d89], [0x8d94, 0x8228, 0x8d98], 0x1402, "isampler2D"], // R16I RG16I RGB16I; *_INTEGER; SHORT
    uint8: [[0x8232, 0x8238, 0x8d7d], [0x8d94, 0x8228, 0x8d98], 0x1401, "usampler2D"], // R8UI RG8UI RGB8UI; *_INTEGER; UNSIGNED_BYTE
};

export class Painter {
    /** @param {HTMLCanvasElement} canvas */
    constructor(canvas) {
        const gl = canvas.getContext("webgl2", { antialias: false, alpha: true, premultipliedAlpha: true });
        if (!gl) throw new Error("This browser has no WebGL 2; switch on hardware acceleration, or use another browser.");
        this.gl = gl;
        this.canvas = canvas;
        /** @type {Map<string, { program: WebGLProgram, at: (name: string) => WebGLUniformLocation | null }>} */
        this.programs = new Map();
        /** @type {Map<object, { texture: WebGLTexture, bytes: number }>} */
        this.textures = new Map();
        this.bytes = 0;
        this.noIds = this.#upload({ values: new Int16Array([0]), dtype: "int16", shape: [1, 1, 1] });
        this.noTable = this.#uploadTable(new Uint8Array(1024), 256, 1);
    }

    /** @param {string} css colour of what no picture covers */
    begin(css) {
        const { gl } = this;
        const [r, g, b] = (css.match(/[\d.]+/g) ?? ["0", "0", "0"]).map(Number);
        gl.disable(gl.SCISSOR_TEST);
        gl.viewport(0, 0, this.canvas.width, this.canvas.height);
        gl.clearColor(r / 255, g / 255, b / 255, 1);
        gl.clear(gl.COLOR_BUFFER_BIT);
    }

    /**
     * Draws a picture, cut to `clip`.
     * @param {Picture} picture
     * @param {Rect} clip
     * @param {Placement} placement
     */
    draw(picture, clip, placement) {
        const { gl } = this;
        const { data } = picture;
        const { program, at } = this.#program(FORMATS[data.dtype][3]);
        gl.useProgram(program);
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(Math.round(clip.x), Math.round(this.canvas.height - clip.y - clip.height), Math.max(0, Math.round(clip.width)), Math.max(0, Math.round(clip.height)));
        const table = picture.table;
        const bound = [
            this.#texture(data, () => this.#upload(data), data.values.byteLength),
            picture.ids ? this.#texture(picture.ids, () => this.#upload(/** @type {LayerData} */ (picture.ids)), picture.ids.values.byteLength) : this.noIds,
            table ? this.#texture(table, () => this.#uploadTable(table, 256, table.length / 1024), table.length) : this.noTable,
        ];
        for (const [unit, texture] of bound.entries()) {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(gl.TEXTURE_2D, texture);
        }
        gl.uniform1i(at("values"), 0);
        gl.uniform1i(at("ids"), 1);
        gl.uniform1i(at("table"), 2);
        gl.uniform1i(at("kind"), KINDS.indexOf(picture.kind));
        gl.uniform2f(at("size"), data.size[1], data.size[0]);
        gl.uniform1f(at("texel"), data.step);
        gl.uniform2f(at("origin"), placement.x, placement.y);
        gl.uniform1f(at("zoom"), placement.zoom);
        gl.uniform1f(at("canvas_height"), this.canvas.height);
        gl.uniform1f(at("exposure"), picture.exposure);
        gl.uniform1i(at("tone"), picture.tone);
        gl.uniform2f(at("range"), ...picture.range);
        gl.uniform1i(at("logarithm"), Number(picture.logarithm));
        gl.uniform1i(at("marked"), picture.ids ? picture.marked : 0);
        gl.uniform1i(at("alone"), Number(picture.alone));
        gl.uniform3f(at("accent"), picture.accent[0], picture.accent[1], picture.accent[2]);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    /**
     * @param {object} owner
     * @param {() => WebGLTexture} make
     * @param {number} bytes
     */
    #texture(owner, make, bytes) {
        const known = this.textures.get(owner);
        if (known) {
            this.textures.delete(owner);
            this.textures.set(owner, known);
            return known.texture;
        }
        const texture = make();
        this.textures.set(owner, { texture, bytes });
        this.bytes += bytes;
        for (const [old, place] of this.textures) {
            if (this.bytes <= MAX_BYTES || this.textures.size <= 8) break;
            this.gl.deleteTexture(place.texture);
            this.textures.delete(old);
            this.bytes -= place.bytes;
        }
        return texture;
    }

    /** @param {{ values: ArrayBufferView, dtype: string, shape: number[] }} data */
    #upload({ values, dtype, shape: [height, width, channels] }) {
        const { gl } = this;
        const [internal, format, type] = FORMATS[dtype];
        const texture = this.#empty();
        gl.texImage2D(gl.TEXTURE_2D, 0, internal[channels - 1], width, height, 0, format[channels - 1], type, values);
        return texture;
    }

    /**
     * @param {Uint8Array} table
     * @param {number} width
     * @param {number} height
     */
    #uploadTable(table, width, height) {
        const { gl } = this;
        const texture = this.#empty();
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, table);
        return texture;
    }

    #empty() {
        const { gl } = this;
        const texture = gl.createTexture();
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
        for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
        return texture;
    }

    /** @param {string} sampler */
    #program(sampler) {
        const known = this.programs.get(sampler);
        if (known) return known;
        const { gl } = this;
        const program = gl.createProgram();
        for (const [type, source] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment(sampler)]])) {
            const shader = /** @type {WebGLShader} */ (gl.createShader(type));
            gl.shaderSource(shader, source);
            gl.compileShader(shader);
            if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader) ?? "a shader does not compile");
            gl.attachShader(program, shader);
        }
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program) ?? "a program does not link");
        /** @type {Map<string, WebGLUniformLocation | null>} */
        const places = new Map();
        const at = (/** @type {string} */ name) => {
            if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
            return places.get(name) ?? null;
        };
        const made = { program, at };
        this.programs.set(sampler, made);
        return made;
    }
}
