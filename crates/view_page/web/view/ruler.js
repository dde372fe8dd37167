// Distances: between the surfaces of two pixels of a frame, by the places that are stored of them, and between two places in 3D.

import { brief, pixelOf } from "./numbers.js";
import { PLACES } from "./session.js";

/** @typedef {import("./session.js").Session} Session */

/** The pixels of a ruler as the state has them. @param {string} ruler @returns {[number, number][]} */
export function endsOf(ruler) {
    const numbers = ruler.split(",").map(Number);
    if (ruler === "" || numbers.some((one) => !Number.isInteger(one) || one < 0) || ![2, 4].includes(numbers.length)) return [];
    return numbers.length === 2 ? [[numbers[0], numbers[1]]] : [[numbers[0], numbers[1]], [numbers[2], numbers[3]]];
}

/** The ruler with another end: the second, or after that the first of a new one, or none at the same pixel. @param {string} ruler @param {{ x: number, y: number }} pixel */
export function withEnd(ruler, { x, y }) {
    const ends = endsOf(ruler);
    return ends.length === 1 ? (ends[0][0] === x && ends[0][1] === y ? "" : `${ends[0]},${x},${y}`) : `${x},${y}`;
}

/**
 * What is measured; null while it is not known. Lengths are metres; `distance` is null where a pixel shows no surface.
 *
 * @param {Session} session
 * @returns {{ distance: number | null, level: number, up: number } | null}
 */
export function measured(session) {
    const { frame, ruler } = session.store.state;
    const ends = endsOf(ruler);
    const data = session.layer(frame, PLACES);
    if (ends.length < 2 || data?.step !== 1) return null;
    const [a, b] = ends.map(([x, y]) => pixelOf(data, x, y));
    if (!a || !b || ![...a, ...b].every(Number.isFinite)) return { distance: null, level: 0, up: 0 };
    return between(a, b);
}

/** @param {number[]} a @param {number[]} b */
function between(a, b) {
    const [x, y, z] = [0, 1, 2].map((axis) => b[axis] - a[axis]);
    return { distance: Math.hypot(x, y, z), level: Math.hypot(x, y), up: z };
}

/** A distance in words: how long, how far on the level and up, and how steep. @param {{ distance: number, level: number, up: number }} found */
const inWords = ({ distance, level, up }) => `${distance.toFixed(3)} m; ${level.toFixed(3)} m level, ${brief(up)} m up, ${((Math.atan2(up, level) * 180) / Math.PI).toFixed(1)}° from level`;

/** The places in 3D as the state has them. @param {string} span @returns {number[][]} */
export function placesOf(span) {
    const numbers = span.split(",").map(Number);
    if (span === "" || !numbers.every(Number.isFinite) || ![3, 6].includes(numbers.length)) return [];
    return [numbers.slice(0, 3), numbers.slice(3)].filter((place) => place.length > 0);
}

/** The distance in 3D with another end: the second, or after that the first of a new one. @param {string} span @param {number[]} place */
export function withPlace(span, place) {
    const text = place.map((v) => String(Number(v.toFixed(4)))).join(",");
    return placesOf(span).length === 1 ? `${span},${text}` : text;
}

/** What is measured in 3D, in words. @param {string} span */
export function spanWords(span) {
    const [a, b] = placesOf(span);
    return b ? inWords(between(a, b)) : "Point at the other end and press J.";
}

/** What is measured, in words. @param {Session} session */
export function rulerWords(session) {
    const { frame, ruler } = session.store.state;
    if (endsOf(ruler).length < 2) return "Point at the other end and press J.";
    if (!session.layersOf(frame).includes(PLACES)) return "This frame has no positions to measure by.";
    const found = measured(session);
    if (!found) return "Reading …";
    return found.distance === null ? "A pixel shows no surface." : inWords({ ...found, distance: found.distance });
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {Session} session
 * @param {import("./painter.js").Placement} place
 * @param {number} ratio device pixels per CSS pixel
 */
export function drawRuler(pen, session, place, ratio) {
    const ends = endsOf(session.store.state.ruler).map(([x, y]) => [place.x + (x + 0.5) * place.zoom, place.y + (y + 0.5) * place.zoom]);
    for (const [style, width] of /** @type {[string, number][]} */ ([["rgb(0 0 0 / 0.8)", 4], ["rgb(255 220 90)", 2]])) {
        [pen.strokeStyle, pen.lineWidth] = [style, width * ratio];
        pen.beginPath();
        for (const [i, [x, y]] of ends.entries()) i === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y);
        for (const [x, y] of ends) {
            pen.moveTo(x + 4 * ratio, y);
            pen.arc(x, y, 4 * ratio, 0, 7);
        }
        pen.stroke();
    }
    const found = measured(session);
    if (ends.length < 2 || !found?.distance) return;
    const text = `${found.distance.toFixed(3)} m`;
    const [x, y] = [0, 1].map((axis) => (ends[0][axis] + ends[1][axis]) / 2);
    pen.font = `${12 * ratio}px ui-monospace, "DejaVu Sans Mono", monospace`;
    [pen.textAlign, pen.textBaseline] = ["center", "middle"];
    const half = pen.measureText(text).width / 2 + 5 * ratio;
    pen.fillStyle = "rgb(0 0 0 / 0.75)";
    pen.fillRect(x - half, y - 10 * ratio, 2 * half, 20 * ratio);
    pen.fillStyle = "white";
    pen.fillText(text, x, y);
}
