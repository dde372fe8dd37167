// A smooth movement from one camera to another.

import { Quaternion, Vector3 } from "../../vendor/three.js";

const DURATION_MS = 450;

/** True when the user has asked their system for less motion. */
export const motionReduced = () => window.matchMedia("(prefers-reduced-motion: reduce)").matches;

/**
 * @typedef {object} Pose
 * @property {Vector3} position
 * @property {Quaternion} quaternion
 * @property {number} fov degrees, vertical
 */

/** One flight, from where `camera` is now. */
export class Flight {
    /**
     * @param {import("../../vendor/three.js").PerspectiveCamera} camera
     * @param {Pose} to
     * @param {number} now milliseconds
     */
    constructor(camera, to, now) {
        this.camera = camera;
        this.from = { position: camera.position.clone(), quaternion: camera.quaternion.clone(), fov: camera.fov };
        this.to = to;
        this.start = now;
    }

    /**
     * Puts the camera where it is at this time. True when it has arrived.
     *
     * @param {number} now milliseconds
     */
    advance(now) {
        const t = Math.min(1, (now - this.start) / DURATION_MS);
        const eased = t * t * (3 - 2 * t);
        this.camera.position.lerpVectors(this.from.position, this.to.position, eased);
        this.camera.quaternion.slerpQuaternions(this.from.quaternion, this.to.quaternion, eased);
        this.camera.fov = this.from.fov + (this.to.fov - this.from.fov) * eased;
        return t >= 1;
    }
}
