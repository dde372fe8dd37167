// The geometry of a scene as the server sends it: one buffer, faces in display order.

/**
 * All arrays are views of one buffer. `F` faces in display order: a prefix of them is a decimation of the scene.
 *
 * @typedef {object} Geometry
 * @property {number} faces F
 * @property {number} pieces number of pieces that faces may name
 * @property {[number, number, number]} min lower corner of the bounds, metres
 * @property {[number, number, number]} max upper corner of the bounds, metres
 * @property {Uint32Array} levelEnds number of faces up to the end of each level of detail; the last is F
 * @property {Uint16Array} positions F × 3 corners × 4: x, y, z as parts of 65535 of the bounds, and 0
 * @property {Uint32Array} faceNumbers F scene face numbers
 * @property {Uint32Array} pieceOfFace F piece numbers
 */

const MAGIC = "ENFGEOM1";
const HEADER_BYTES = 64;

/**
 * Reads the buffer of `/api/…/geometry`; copies nothing.
 *
 * @param {ArrayBuffer} buffer
 * @returns {Geometry}
 * @throws {Error} when it is not such a buffer, or is cut short
 */
export function readGeometry(buffer) {
    const magic = buffer.byteLength < HEADER_BYTES ? "" : String.fromCharCode(...new Uint8Array(buffer, 0, 8));
    if (magic !== MAGIC) throw new Error(`The server's geometry begins with "${magic}", not ${MAGIC}. Reload the page; it may be older than the program.`);
    const header = new DataView(buffer);
    const faces = header.getUint32(8, true);
    const pieces = header.getUint32(12, true);
    /** @param {number} at @returns {[number, number, number]} */
    const point = (at) => [header.getFloat32(at, true), header.getFloat32(at + 4, true), header.getFloat32(at + 8, true)];
    const levels = header.getUint32(40, true);
    const levelBytes = Math.ceil((levels * 4) / 16) * 16;
    const positionsAt = HEADER_BYTES + levelBytes;
    const facesAt = positionsAt + faces * 24;
    const bytes = facesAt + faces * 8;
    if (buffer.byteLength < bytes) throw new Error(`The geometry has ${buffer.byteLength} bytes; ${faces} faces need ${bytes}. Reload the page.`);
    return {
        faces,
        pieces,
        min: point(16),
        max: point(28),
        levelEnds: new Uint32Array(buffer, HEADER_BYTES, levels),
        positions: new Uint16Array(buffer, positionsAt, faces * 12),
        faceNumbers: new Uint32Array(buffer, facesAt, faces),
        pieceOfFace: new Uint32Array(buffer, facesAt + faces * 4, faces),
    };
}

/**
 * The corners of a face in the world, metres.
 *
 * @param {Geometry} geometry
 * @param {number} index place in display order
 * @returns {[number, number, number][]}
 */
export function corners(geometry, index) {
    const { min, max, positions } = geometry;
    /** @param {number} corner @param {number} axis */
    const at = (corner, axis) => min[axis] + (positions[index * 12 + corner * 4 + axis] / 65535) * (max[axis] - min[axis]);
    return [0, 1, 2].map((corner) => [at(corner, 0), at(corner, 1), at(corner, 2)]);
}
