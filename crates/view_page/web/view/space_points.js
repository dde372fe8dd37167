// The points of a frame in 3D: discs as large as the pixels that they were, so that they close the surfaces they lie on.

import { BufferAttribute, BufferGeometry, Color, Points, PointsMaterial, SRGBColorSpace } from "../vendor/three.js";

/** Linear light of each byte of sRGB, 0 to 1. */
const LIGHT = Float32Array.from({ length: 256 }, (_, value) => new Color().setRGB(value / 255, 0, 0, SRGBColorSpace).r);
/** Diameter of a disc, in distances between neighbours. */
const COVER = 1.5;
/** A neighbour that is farther than this many pixels is across an edge; surfaces at that slant are left open. */
const FARTHEST = 6;
/** Points are drawn nearer by this share of their distance, so that the surfaces on which they lie do not show through. */
const NEARER = 0.01;

/**
 * The points of an answer of the server.
 * @param {ArrayBuffer} buffer
 * @param {number[]} eye position of the frame's camera, metres
 * @param {{ pixel: number, columns: number }} grid distance of neighbouring points at a metre before the camera, metres; points in a row
 */
export function framePoints(buffer, eye, grid) {
    const count = new DataView(buffer).getUint32(8, true);
    const places = new Float32Array(buffer, 16, 3 * count);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(places, 3));
    // three.js takes linear light and converts it to sRGB.
    geometry.setAttribute("color", new BufferAttribute(Float32Array.from(new Uint8Array(buffer, 16 + 12 * count, 4 * count), (value) => LIGHT[value]), 4));
    geometry.setAttribute("spacing", new BufferAttribute(spacings(places, eye, grid), 1));
    const material = new PointsMaterial({ size: 1, sizeAttenuation: true, vertexColors: true, toneMapped: false });
    material.onBeforeCompile = (shader) => {
        shader.vertexShader = shader.vertexShader
            .replace("uniform float size;", "uniform float size;\nattribute float spacing;")
            // A disc of this diameter at a metre, in pixels: the height of the view is 2 / projectionMatrix[1][1] there.
            .replace("gl_PointSize = size;", `gl_PointSize = size * spacing * projectionMatrix[1][1];\n\tgl_Position = projectionMatrix * vec4(mvPosition.xyz * ${1 - NEARER}, 1.0);`);
    };
    return new Points(geometry, material);
}

/**
 * The diameter of each disc, metres: at a slant neighbours lie farther apart than pixels do.
 * @param {Float32Array} places
 * @param {number[]} eye
 * @param {{ pixel: number, columns: number }} grid
 */
function spacings(places, eye, { pixel, columns }) {
    const count = places.length / 3;
    const apart = (/** @type {number} */ i, /** @type {number} */ j) => Math.hypot(places[3 * i] - places[3 * j], places[3 * i + 1] - places[3 * j + 1], places[3 * i + 2] - places[3 * j + 2]);
    return Float32Array.from({ length: count }, (_, i) => {
        const own = pixel * Math.hypot(places[3 * i] - eye[0], places[3 * i + 1] - eye[1], places[3 * i + 2] - eye[2]);
        // Rows have gaps where nothing was hit; what is no neighbour then is too far, or the other neighbour counts.
        const far = [i + 1, i + columns].map((j) => (j < count ? apart(i, j) : 0)).filter((distance) => distance < FARTHEST * own);
        return COVER * Math.max(own, ...far);
    });
}
