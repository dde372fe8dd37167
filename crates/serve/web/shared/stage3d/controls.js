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

/** Turning by key code: to the left and up. */
const TURN = /** @type {Record<string, [number, number]>} */ ({ ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] });
/** Radians per second of turning by keys. */
const TURN_RAD_PER_S = 1.2;
/** A key that is pressed shortly turns as far as one that is held for this long, seconds. */
const SHORT_TURN_S = 0.05;

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
        /** The camera stays this near to a point, metres. */
        this.bounds = { centre: new Vector3(), radius: Infinity };
        /** @type {Set<string>} */
        this.held = new Set();
        /** True when arrow keys turn the camera; else the page has them. */
        this.arrowsTurn = false;
        /** True when keys turn the camera on the spot, and not about the look-at point. */
        this.onTheSpot = false;
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

    /** Keeps the wheel from taking the camera farther than this from a point. @param {Vector3} centre @param {number} radius metres */
    bound(centre, radius) {
        this.bounds = { centre, radius };
    }

    /**
     * Takes a key of flying or turning. True when it is one.
     *
     * @param {KeyboardEvent} event
     */
    key(event) {
        const turns = this.arrowsTurn && event.code in TURN;
        if (event.ctrlKey || event.metaKey || event.altKey || !(turns || event.code in FLY)) return false;
        if (turns) {
            this.onTheSpot = event.shiftKey;
            if (!this.held.has(event.code)) this.turn(TURN[event.code], SHORT_TURN_S);
        }
        this.held.add(event.code);
        this.changed();
        return true;
    }

    /** Turns by keys. @param {[number, number]} way to the left, and up @param {number} seconds */
    turn([left, up], seconds) {
        const [yaw, pitch] = [left * TURN_RAD_PER_S * seconds, up * TURN_RAD_PER_S * seconds];
        if (!this.onTheSpot) return this.orbit(-yaw, -pitch);
        const eye = this.camera.position.clone();
        // The point goes around the camera, and the camera stays.
        const arm = this.lookAt.clone().sub(eye);
        this.lookAt.copy(eye).add(turned(arm, yaw, -pitch));
        this.aim();
    }

    /**
     * Flies on for as long as keys are held.
     *
     * @param {number} seconds since the frame before
     */
    fly(seconds) {
        if (this.held.size === 0) return;
        const time = Math.min(seconds, 0.1);
        const step = new Vector3();
        for (const code of this.held) {
            if (code in TURN) this.turn(TURN[code], time);
            else step.add(new Vector3(...FLY[code]));
        }
        const ahead = forward(this.camera.quaternion);
        const right = new Vector3(1, 0, 0).applyQuaternion(this.camera.quaternion);
        const move = ahead.multiplyScalar(step.z).addScaledVector(right, step.x).add(new Vector3(0, 0, step.y));
        if (move.lengthSq() > 0) this.shift(move.setLength(this.speed * time));
    }

    /**
     * Turns about the look-at point.
     *
     * @param {number} yaw radians, counter-clockwise from above
     * @param {number} pitch radians, upward
     */
    orbit(yaw, pitch) {
        const arm = this.camera.position.clone().sub(this.lookAt);
        this.camera.position.copy(this.lookAt).add(turned(arm, yaw, pitch));
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
        const { centre, radius } = this.bounds;
        const to = this.camera.position.clone().addScaledVector(arm.normalize(), wanted - distance);
        if (amount > 0 && to.distanceTo(centre) > radius) return;
        this.camera.position.copy(to);
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

/**
 * An arm that is turned about the vertical, and up or down, but not over the poles.
 *
 * @param {Vector3} arm metres
 * @param {number} yaw radians, counter-clockwise from above
 * @param {number} pitch radians, downward
 */
function turned(arm, yaw, pitch) {
    const length = arm.length();
    const guard = MathUtils.degToRad(POLE_GUARD_DEG);
    const polar = MathUtils.clamp(Math.acos(MathUtils.clamp(arm.z / length, -1, 1)) + pitch, guard, Math.PI - guard);
    const azimuth = Math.atan2(arm.y, arm.x) + yaw;
    const flat = Math.sin(polar) * length;
    return new Vector3(Math.cos(azimuth) * flat, Math.sin(azimuth) * flat, Math.cos(polar) * length);
}
