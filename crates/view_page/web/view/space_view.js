// The camera of the 3D view as a word of the address: position, the point that orbiting turns about, and the vertical angle.

import { lookingAt } from "../shared/stage3d/camera.js";
import { Matrix4, Vector3 } from "../vendor/three.js";

/** Decimals of metres and degrees. */
const DIGITS = 3;

/**
 * @param {import("../shared/stage3d/stage.js").Stage3d} stage
 * @param {boolean} above ceilings are off
 */
export function viewOf({ camera, controls }, above) {
    const numbers = [...camera.position.toArray(), ...controls.lookAt.toArray(), camera.fov];
    return numbers.map((value) => String(Number(value.toFixed(DIGITS)))).concat(above ? ["above"] : []).join(",");
}

/**
 * What such a word means; `null` where it means nothing.
 * @param {string} view
 */
export function placeOf(view) {
    const words = view.split(",");
    const numbers = words.slice(0, 7).map(Number);
    if (numbers.length < 7 || !numbers.every(Number.isFinite) || !(numbers[6] > 1 && numbers[6] < 170)) return null;
    const [position, target] = [numbers.slice(0, 3), numbers.slice(3, 6)];
    if (Math.hypot(...position.map((v, i) => v - target[i])) < 1e-6) return null;
    const m = new Matrix4().makeRotationFromQuaternion(lookingAt(new Vector3(...position), new Vector3(...target))).elements;
    const orientation = [m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]];
    return { camera: { position, orientation, fov_y_deg: numbers[6] }, target: /** @type {[number, number, number]} */ (target), above: words[7] === "above" };
}
