// Moving the camera: orbit, pan, dolly and fly. What the buttons and keys do is Hypersim's annotation tool's; steps are metres.

import { MathUtils, Vector3 } from "../../vendor/three.js";
import { forward, lookingAt } from "./camera.js";

/** Minimum angle between the view and straight up or down. */
const POLE_GUARD_DEG = 1;
/** Minimum distance from the camera to the look-at point, metres; beyond that the wheel moves the point ahead. */
const NEAREST_M = 0.3;
/** Half a turn for a drag over the height of the view. */
const ORBIT_RAD_PER_HEIGHT = Math.PI;

/** Directions of flying by key code, which names the position of a key and not its letter. */
const FLY = /** @type {Record<string, [number, number, number]>} */ ({
    KeyW: [0, 0, 1],
    KeyS: [0, 0, -1],
    KeyA: [-1, 0, 0],
    KeyD: [1, 0, 0],
    KeyR: [0, 1, 0],
    KeyF: [0, -1, 0],
});

/** Moves a camera by pointer and keys, and calls `changed`. It draws nothing. */
export class Controls {
    /**
     * @param {HTMLElement} element what takes the pointer
     * @param {import("../../vendor/three.js").PerspectiveCamera} camera
     * @param {() => void} changed called after each movement
     */
    constructor(element, camera, changed) {
        this.element = element;
        this.camera = camera;
        this.changed = changed;
        /** The point that orbit turns about. */
        this.lookAt = new Vector3();
        /** Metres per second of flying. */
        this.speed = 1.5;
        /** True for a press of a button that the page uses for something else, such as drawing. @type {(event: PointerEvent) => boolean} */
        this.claimed = () => false;
        /** @type {Set<string>} */
        this.held = new Set();
        /** @type {{ id: number, kind: "orbit" | "pan", x: number, y: number } | null} */
        this.drag = null;
        this.abort = new AbortController();
        const on = { signal: this.abort.signal };
        element.addEventListener("pointerdown", (event) => this.press(event), on);
        element.addEventListener("pointermove", (event) => this.move(event), on);
        element.addEventListener("pointerup", (event) => this.release(event), on);
        element.addEventListener("pointercancel", (event) => this.release(event), on);
        element.addEventListener("wheel", (event) => this.wheel(event), { ...on, passive: false });
        element.addEventListener("contextmenu", (event) => event.preventDefault(), on);
        window.addEventListener("blur", () => this.held.clear(), on);
        window.addEventListener("keyup", (event) => this.held.delete(event.code), on);
    }

    /** True while a button or a key moves the camera. */
    get active() {
        return this.drag !== null || this.held.size > 0;
    }

    /** @param {PointerEvent} event */
    press(event) {
        if (this.drag || this.claimed(event) || (event.button !== 0 && event.button !== 1 && event.button !== 2)) return;
        this.drag = { id: event.pointerId, kind: event.button === 0 ? "orbit" : "pan", x: event.clientX, y: event.clientY };
        this.element.setPointerCapture(event.pointerId);
    }

    /** @param {PointerEvent} event */
    move(event) {
        const { drag } = this;
        if (!drag || drag.id !== event.pointerId) return;
        const height = this.element.clientHeight || 1;
        const [dx, dy] = [(event.clientX - drag.x) / height, (event.clientY - drag.y) / height];
        [drag.x, drag.y] = [event.clientX, event.clientY];
        if (drag.kind === "orbit") this.orbit(-dx * ORBIT_RAD_PER_HEIGHT, -dy * ORBIT_RAD_PER_HEIGHT);
        else this.pan(dx, dy);
    }

    /** @param {PointerEvent} event */
    release(event) {
        if (this.drag?.id === event.pointerId) this.drag = null;
    }

    /** @param {WheelEvent} event */
    wheel(event) {
        event.preventDefault();
        const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1);
        this.dolly(MathUtils.clamp(pixels, -300, 300) * (event.ctrlKey ? 0.01 : 0.002));
    }

    /**
     * Takes a key of flying. True when it is one.
     *
     * @param {KeyboardEvent} event
     */
    key(event) {
        if (!(event.code in FLY) || event.ctrlKey || event.metaKey || event.altKey) return false;
        this.held.add(event.code);
        this.changed();
        return true;
    }

    /**
     * Flies on for as long as keys are held.
     *
     * @param {number} seconds since the frame before
     */
    fly(seconds) {
        if (this.held.size === 0) return;
        const step = new Vector3();
        for (const code of this.held) step.add(new Vector3(...FLY[code]));
        const ahead = forward(this.camera.quaternion);
        const right = new Vector3(1, 0, 0).applyQuaternion(this.camera.quaternion);
        const move = ahead.multiplyScalar(step.z).addScaledVector(right, step.x).add(new Vector3(0, 0, step.y));
        if (move.lengthSq() > 0) this.shift(move.setLength(this.speed * Math.min(seconds, 0.1)));
    }

    /**
     * Turns about the look-at point.
     *
     * @param {number} yaw radians, counter-clockwise from above
     * @param {number} pitch radians, upward
     */
    orbit(yaw, pitch) {
        const arm = this.camera.position.clone().sub(this.lookAt);
        const distance = arm.length();
        const guard = MathUtils.degToRad(POLE_GUARD_DEG);
        const polar = MathUtils.clamp(Math.acos(MathUtils.clamp(arm.z / distance, -1, 1)) + pitch, guard, Math.PI - guard);
        const azimuth = Math.atan2(arm.y, arm.x) + yaw;
        const flat = Math.sin(polar) * distance;
        arm.set(Math.cos(azimuth) * flat, Math.sin(azimuth) * flat, Math.cos(polar) * distance);
        this.camera.position.copy(this.lookAt).add(arm);
        this.aim();
    }

    /**
     * Moves sideways and up, as far as the pointer moves at the look-at point.
     *
     * @param {number} dx to the right, in heights of the view
     * @param {number} dy downward
     */
    pan(dx, dy) {
        const height = 2 * Math.tan(MathUtils.degToRad(this.camera.fov) / 2) * this.camera.position.distanceTo(this.lookAt);
        const right = new Vector3(1, 0, 0).applyQuaternion(this.camera.quaternion);
        const up = new Vector3(0, 1, 0).applyQuaternion(this.camera.quaternion);
        this.shift(right.multiplyScalar(-dx * height).addScaledVector(up, dy * height));
    }

    /**
     * Moves away from the look-at point or toward it. A camera that would come too close pushes the point ahead.
     *
     * @param {number} amount natural logarithm of the distance's growth
     */
    dolly(amount) {
        const arm = this.camera.position.clone().sub(this.lookAt);
        const distance = arm.length();
        const wanted = distance * Math.exp(amount);
        this.camera.position.addScaledVector(arm.normalize(), wanted - distance);
        if (wanted < NEAREST_M) this.lookAt.copy(this.camera.position).addScaledVector(arm, -NEAREST_M);
        this.changed();
    }

    /** Moves camera and look-at point by the same amount. @param {Vector3} by metres */
    shift(by) {
        this.camera.position.add(by);
        this.lookAt.add(by);
        this.changed();
    }

    /** Puts the look-at point ahead of the camera. @param {number} distance metres */
    resetLookAt(distance) {
        this.lookAt.copy(this.camera.position).addScaledVector(forward(this.camera.quaternion), Math.max(distance, NEAREST_M));
    }

    /** Turns the camera to the look-at point. */
    aim() {
        this.camera.quaternion.copy(lookingAt(this.camera.position, this.lookAt));
        this.changed();
    }

    dispose() {
        this.abort.abort();
    }
}
