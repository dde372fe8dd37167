// Reading back from the graphics card what the view shows: which piece, which face, where.

import { Plane, Ray, Vector3 } from "../../vendor/three.js";
import { corners } from "./geometry.js";
import { XRAY } from "./shaders.js";

/**
 * The view that is read, as the stage has it.
 *
 * @typedef {object} Stage
 * @property {WebGL2RenderingContext} gl
 * @property {import("../../vendor/three.js").WebGLRenderer} renderer
 * @property {HTMLElement} element
 * @property {import("./picture.js").SeenTarget} shown
 * @property {import("./tables.js").Tables} tables
 * @property {import("../../vendor/three.js").PerspectiveCamera} camera
 * @property {import("./mesh.js").SceneMesh | null} mesh
 */

/**
 * Values of a rectangle of the target that is shown: four numbers per sample, of which the first two count.
 *
 * @param {Stage} stage
 * @param {number} x left, CSS pixels
 * @param {number} y top
 * @param {number} width CSS pixels
 * @param {number} height
 */
function read(stage, x, y, width, height) {
    const { gl, renderer, shown, element } = stage;
    if (!shown.target) return new Uint32Array(0);
    const scale = shown.target.width / Math.max(1, element.clientWidth);
    const left = Math.max(0, Math.floor(x * scale));
    const right = Math.min(shown.target.width, Math.max(left + 2, Math.ceil((x + width) * scale)));
    const top = Math.max(0, Math.floor(y * scale));
    const bottom = Math.min(shown.target.height, Math.max(top + 2, Math.ceil((y + height) * scale)));
    if (right <= left || bottom <= top) return new Uint32Array(0);
    const values = new Uint32Array((right - left) * (bottom - top) * 4);
    renderer.setRenderTarget(shown.target);
    gl.readPixels(left, shown.target.height - bottom, right - left, bottom - top, gl.RGBA_INTEGER, gl.UNSIGNED_INT, values);
    renderer.setRenderTarget(null);
    return values;
}

/**
 * What is seen at a pixel, as the stage says it. Reads 2 × 2 samples, because a piece that is seen through covers one sample of four.
 *
 * @param {Stage} stage
 * @param {number} x
 * @param {number} y
 */
export function seenAt(stage, x, y) {
    const values = read(stage, x, y, 1, 1);
    let best = { piece: -1, face: -1 };
    for (let i = 0; i < values.length; i += 4) {
        const piece = (values[i] >>> 8) - 1;
        if (piece < 0) continue;
        best = { piece, face: values[i + 1] };
        if (!(stage.tables.flags[piece] & XRAY)) break;
    }
    return best;
}

/** @param {Stage} stage @param {number[]} rectangle @returns {Set<number>} */
export function seenIn(stage, [x0, y0, x1, y1]) {
    const values = read(stage, Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0) + 1, Math.abs(y1 - y0) + 1);
    const pieces = new Set();
    let last = 0;
    for (let i = 0; i < values.length; i += 4) {
        const code = values[i] >>> 8;
        if (code === last || code === 0) continue;
        last = code;
        if (!(stage.tables.flags[code - 1] & XRAY)) pieces.add(code - 1);
    }
    return pieces;
}

/**
 * Where the ray through a pixel meets the plane of a face.
 *
 * @param {Stage} stage
 * @param {number} face scene face number
 * @param {number} x
 * @param {number} y
 * @returns {Vector3 | null}
 */
export function hitPoint(stage, face, x, y) {
    const { camera, mesh, element } = stage;
    if (!mesh) return null;
    const [a, b, c] = corners(mesh.geometry, mesh.place(face)).map((point) => new Vector3(...point));
    const ndc = new Vector3(((x + 0.5) / element.clientWidth) * 2 - 1, 1 - ((y + 0.5) / element.clientHeight) * 2, 0.5);
    const ray = new Ray(camera.position, ndc.unproject(camera).sub(camera.position).normalize());
    return ray.intersectPlane(new Plane().setFromCoplanarPoints(a, b, c), new Vector3());
}
