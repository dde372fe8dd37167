// Points that are followed through the frames of a camera: read once, and drawn over its pictures, with a tail of where they came from.

import { toastError } from "../shared/toast.js";
import { getTracks } from "./catalogue.js";
import { cssColor, idColor } from "./colors.js";

/** @typedef {{ frames: Uint32Array, points: Float32Array, occluded: Uint8Array }} Followed points of a camera: by point, then frame, shares of width and height, and 1 where hidden or outside */

/** A tail shows this many frames before. */
const TAIL = 6;
/** Radius of a point, CSS pixels. */
const RADIUS = 3;
/** Opacity of the others while one is followed alone. */
const OTHERS = 0.25;

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

/** Where a point is in a frame, shares of width and height; null where it is not in the picture. @param {Followed} followed @param {number} at point and frame */
function placeIn({ points }, at) {
    const [x, y] = [points[2 * at], points[2 * at + 1]];
    return x >= 0 && x <= 1 && y >= 0 && y <= 1 ? [x, y] : null;
}

/** Number of points. @param {Followed} followed */
export const countOf = ({ occluded, frames }) => (frames.length > 0 ? occluded.length / frames.length : 0);

/** Where a point is in a frame, and in how many frames it is seen. @param {Followed} followed @param {number} track from 1 @param {number} frame */
export function factsOf(followed, track, frame) {
    const { frames, occluded } = followed;
    const [first, now] = [(track - 1) * frames.length, frames.indexOf(frame)];
    const seen = [...frames].filter((_, i) => !occluded[first + i] && placeIn(followed, first + i));
    return { place: now < 0 ? null : placeIn(followed, first + now), isSeen: seen.includes(frame), seen };
}

/**
 * The point nearest to a place, from 1; 0 where none is in reach.
 *
 * @param {Followed} followed
 * @param {number} frame
 * @param {number[]} place shares of width and height
 * @param {number[]} reach
 */
export function trackAt(followed, frame, place, reach) {
    const { frames } = followed;
    const now = frames.indexOf(frame);
    let best = { track: 0, far: 1 };
    for (let point = 0; now >= 0 && point < countOf(followed); point++) {
        const there = placeIn(followed, point * frames.length + now);
        const far = there ? Math.hypot((there[0] - place[0]) / reach[0], (there[1] - place[1]) / reach[1]) : Infinity;
        if (far < best.far) best = { track: point + 1, far };
    }
    return best.track;
}

/** The next point that a frame sees, from 1; 0 where it sees none. @param {Followed} followed @param {number} frame @param {number} after */
export function nextTrack(followed, frame, after) {
    const { frames, occluded } = followed;
    const [now, count] = [frames.indexOf(frame), countOf(followed)];
    for (let step = 1; now >= 0 && step <= count; step++) {
        const point = (after - 1 + step + count) % count;
        const at = point * frames.length + now;
        if (!occluded[at] && placeIn(followed, at)) return point + 1;
    }
    return 0;
}

/**
 * Draws the points of a frame: dots where they are seen, rings where they are hidden, each with a tail. Of one that is followed alone the
 * whole way is drawn.
 *
 * @param {CanvasRenderingContext2D} pen
 * @param {Followed} followed
 * @param {number} frame
 * @param {{ x: number, y: number, width: number, height: number }} picture where it lies, device pixels
 * @param {number} ratio device pixels per CSS pixel
 * @param {number} alone the point that is followed alone, from 1; 0: all
 */
export function drawTracks(pen, followed, frame, picture, ratio, alone = 0) {
    const { frames, occluded } = followed;
    const now = frames.indexOf(frame);
    if (now < 0) return;
    const place = (/** @type {number} */ at) => {
        const there = placeIn(followed, at);
        return there && [picture.x + there[0] * picture.width, picture.y + there[1] * picture.height];
    };
    const line = (/** @type {number} */ at, /** @type {number} */ opacity) => {
        const [from, to] = [place(at), place(at + 1)];
        if (!from || !to) return;
        pen.globalAlpha = opacity;
        pen.beginPath();
        pen.moveTo(from[0], from[1]);
        pen.lineTo(to[0], to[1]);
        pen.stroke();
    };
    // The one that stands out comes last, above the others.
    const order = [...Array(countOf(followed)).keys()].filter((point) => point + 1 !== alone).concat(alone > 0 && alone <= countOf(followed) ? [alone - 1] : []);
    for (const point of order) {
        const [first, isAlone] = [point * frames.length, point + 1 === alone];
        const at = first + now;
        const there = place(at);
        const opacity = alone > 0 && !isAlone ? OTHERS : 1;
        const color = cssColor(idColor(point + 1));
        pen.strokeStyle = color;
        pen.lineWidth = (isAlone ? 2.5 : 1.5) * ratio;
        if (isAlone) for (let i = 0; i + 1 < frames.length; i++) line(first + i, i < now ? 0.9 : 0.45);
        else if (there && opacity === 1) for (let back = 0; back < TAIL && now - back > 0 && place(at - back - 1); back++) line(at - back - 1, 0.8 * (1 - back / TAIL));
        if (!there) continue;
        pen.globalAlpha = opacity;
        pen.beginPath();
        pen.arc(there[0], there[1], (isAlone ? 2 : 1) * RADIUS * ratio, 0, 7);
        if (!occluded[at]) {
            pen.fillStyle = color;
            pen.fill();
            pen.strokeStyle = "rgb(0 0 0 / 0.75)";
            pen.lineWidth = ratio;
        }
        pen.stroke();
    }
    pen.globalAlpha = 1;
}
