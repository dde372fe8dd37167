// Points that are followed through the frames of a camera: read once, and drawn over its pictures, with a tail of where they came from.

import { toastError } from "../shared/toast.js";
import { getTracks } from "./catalogue.js";
import { cssColor, idColor } from "./colors.js";

/** @typedef {{ frames: Uint32Array, points: Float32Array, occluded: Uint8Array }} Followed points of a camera: by point, then frame, shares of width and height, and 1 where hidden or outside */

/** A tail shows this many frames before. */
const TAIL = 6;
/** Radius of a point, CSS pixels. */
const RADIUS = 3;

export class Tracks {
    /** @param {import("./session.js").Session} session */
    constructor(session) {
        this.session = session;
        /** By scene and camera; null while on the way, and where they cannot be read. @type {Map<string, Followed | null>} */
        this.known = new Map();
    }

    /** The points of a camera, once they are here. @param {import("./catalogue.js").Camera} camera */
    of(camera) {
        const scene = this.session.scene?.name ?? "";
        const key = `${scene}/${camera.name}`;
        if (camera.has_tracks && !this.known.has(key)) {
            this.known.set(key, null);
            getTracks(scene, camera.name).then((bytes) => {
                this.known.set(key, followedIn(bytes));
                this.session.changed();
            }).catch(toastError);
        }
        return this.known.get(key) ?? null;
    }

    /** Forgets everything, so that files are read again. */
    forget() {
        this.known.clear();
    }
}

/** @param {ArrayBuffer} bytes @returns {Followed} */
function followedIn(bytes) {
    const [points, frames] = new Uint32Array(bytes, 8, 2);
    const places = 16 + 4 * frames;
    return {
        frames: new Uint32Array(bytes, 16, frames),
        points: new Float32Array(bytes, places, 2 * points * frames),
        occluded: new Uint8Array(bytes, places + 8 * points * frames, points * frames),
    };
}

/**
 * Draws the points of a frame: dots where they are seen, rings where they are hidden.
 * @param {CanvasRenderingContext2D} pen
 * @param {Followed} followed
 * @param {number} frame
 * @param {{ x: number, y: number, width: number, height: number }} picture where it lies, device pixels
 * @param {number} ratio device pixels per CSS pixel
 */
export function drawTracks(pen, { frames, points, occluded }, frame, picture, ratio) {
    const now = frames.indexOf(frame);
    if (now < 0) return;
    const isThere = (/** @type {number} */ at) => points[2 * at] >= 0 && points[2 * at] <= 1 && points[2 * at + 1] >= 0 && points[2 * at + 1] <= 1;
    const place = (/** @type {number} */ at) => [picture.x + points[2 * at] * picture.width, picture.y + points[2 * at + 1] * picture.height];
    const radius = RADIUS * ratio;
    for (let point = 0; point < occluded.length / frames.length; point++) {
        const at = point * frames.length + now;
        if (!isThere(at)) continue;
        const [x, y] = place(at);
        const color = cssColor(idColor(point + 1));
        pen.strokeStyle = color;
        pen.lineWidth = 1.5 * ratio;
        for (let back = 0; back < TAIL && now - back > 0 && isThere(at - back - 1); back++) {
            const [from, to] = [place(at - back - 1), place(at - back)];
            pen.globalAlpha = 0.8 * (1 - back / TAIL);
            pen.beginPath();
            pen.moveTo(from[0], from[1]);
            pen.lineTo(to[0], to[1]);
            pen.stroke();
        }
        pen.globalAlpha = 1;
        pen.beginPath();
        pen.arc(x, y, radius, 0, 7);
        if (!occluded[at]) {
            pen.fillStyle = color;
            pen.fill();
            pen.strokeStyle = "rgb(0 0 0 / 0.75)";
            pen.lineWidth = ratio;
        }
        pen.stroke();
    }
}
