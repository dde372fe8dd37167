// Conversion between the cameras of the server and the camera of the view.

import { Matrix4, PerspectiveCamera, Quaternion, Vector3 } from "../../vendor/three.js";

/**
 * A camera of the contract: axes x right, y up, z backward, in a world of metres with z up.
 *
 * @typedef {object} CameraJson
 * @property {number[]} position metres
 * @property {number[]} orientation world_from_camera, 9 numbers, row by row
 * @property {number} fov_y_deg vertical field of view, degrees
 * @property {number} [aspect] width by height of its picture
 * @property {number} [width] pixels
 * @property {number} [height] pixels
 */

/**
 * The rotation of a camera.
 *
 * @param {number[]} orientation 9 numbers, row by row
 */
export function rotation(orientation) {
    const [a, b, c, d, e, f, g, h, i] = orientation;
    return new Quaternion().setFromRotationMatrix(new Matrix4().set(a, b, c, 0, d, e, f, 0, g, h, i, 0, 0, 0, 0, 1));
}

/**
 * The camera of the view, as the server takes it.
 *
 * @param {PerspectiveCamera} camera
 * @param {number} width pixels of the picture
 * @param {number} height
 * @param {number} near_m what is nearer is not seen, metres
 * @returns {CameraJson & { width: number, height: number, near_m: number }}
 */
export function cameraJson(camera, width, height, near_m) {
    camera.updateMatrixWorld();
    const m = camera.matrixWorld.elements;
    return {
        position: camera.position.toArray(),
        orientation: [m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]],
        fov_y_deg: camera.fov,
        width,
        height,
        near_m,
    };
}

/**
 * The field of view that shows the whole picture of `json` in a window of another shape.
 *
 * @param {CameraJson} json
 * @param {number} aspect width by height of the window
 */
export function fittingFov(json, aspect) {
    const own = json.aspect ?? (json.width && json.height ? json.width / json.height : aspect);
    const half = Math.tan((json.fov_y_deg * Math.PI) / 360) * Math.max(1, own / aspect);
    return Math.min(150, (Math.atan(half) * 360) / Math.PI);
}

/**
 * A camera at `position` that looks at `target`, z up.
 *
 * @param {Vector3} position
 * @param {Vector3} target
 */
export function lookingAt(position, target) {
    const back = position.clone().sub(target).normalize();
    const up = Math.abs(back.z) > 0.9999 ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
    return new Quaternion().setFromRotationMatrix(new Matrix4().lookAt(position, target, up));
}

/** The direction that a camera looks in. @param {Quaternion} quaternion */
export const forward = (quaternion) => new Vector3(0, 0, -1).applyQuaternion(quaternion);
