// Distributions as small bars, in the colours of the theme.

import { el } from "../shared/dom.js";
import { pixelOf } from "./numbers.js";

/** Height of the tallest bar, in units of the drawing. */
const HEIGHT = 36;

/**
 * How many values fall into each of some equal parts of a range; those outside are left out.
 * @param {ArrayLike<number>} values
 * @param {[number, number]} range
 * @param {number} parts
 */
export function countsOf(values, [low, high], parts) {
    const counts = new Array(parts).fill(0);
    const scale = parts / (high - low || 1);
    for (let i = 0; i < values.length; i++) {
        const value = values[i];
        if (value >= low && value <= high) counts[Math.min(parts - 1, Math.floor((value - low) * scale))]++;
    }
    return counts;
}

/** Samples of layers: a number per pixel, of some of the pixels. @type {WeakMap<import("./numbers.js").LayerData, Float32Array>} */
const samples = new WeakMap();

/**
 * Numbers of a layer, of 16384 pixels at most: of a colour its brightness, of a vector its length.
 * @param {import("./numbers.js").LayerData} data
 */
export function sampleOf(data) {
    const known = samples.get(data);
    if (known) return known;
    const [height, width] = data.shape;
    const stride = Math.max(1, Math.ceil(Math.sqrt((height * width) / 16384)));
    const sample = [];
    for (let y = 0; y < height; y += stride) {
        for (let x = 0; x < width; x += stride) {
            const v = pixelOf(data, x * data.step, y * data.step) ?? [];
            const value = v.length < 2 ? v[0] : data.summary.of === "brightness" ? 0.3 * v[0] + 0.59 * v[1] + 0.11 * v[2] : Math.hypot(...v);
            if (Number.isFinite(value)) sample.push(value);
        }
    }
    const made = Float32Array.from(sample);
    samples.set(data, made);
    return made;
}

/**
 * The distribution of values as a drawing; bars within `chosen` stand out.
 * @param {ArrayLike<number>} values
 * @param {[number, number]} range
 * @param {number} parts
 * @param {[number, number]} chosen
 * @param {(value: number) => string} show a value in words
 * @param {((range: [number, number] | null) => void)} [choose] takes the range that is dragged over; null for a click, which takes it back
 */
export function barsOf(values, range, parts, chosen, show, choose) {
    const counts = countsOf(values, range, parts);
    const most = Math.max(1, ...counts);
    const width = (range[1] - range[0]) / parts;
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("viewBox", `0 0 ${parts * 4} ${HEIGHT}`);
    svg.setAttribute("preserveAspectRatio", "none");
    svg.setAttribute("role", "img");
    svg.setAttribute("aria-label", `${values.length} values from ${show(range[0])} to ${show(range[1])}`);
    for (const [i, count] of counts.entries()) {
        const bar = document.createElementNS("http://www.w3.org/2000/svg", "rect");
        // Square roots: few outliers are seen beside many of the rest.
        const height = HEIGHT * Math.sqrt(count / most);
        const [from, to] = [range[0] + i * width, range[0] + (i + 1) * width];
        const place = { x: 4 * i, y: HEIGHT - height, width: 3.2, height, class: to >= chosen[0] && from <= chosen[1] ? "chosen" : "" };
        for (const [name, value] of Object.entries(place)) bar.setAttribute(name, String(value));
        const title = document.createElementNS("http://www.w3.org/2000/svg", "title");
        title.textContent = `${show(from)} to ${show(to)}: ${count}`;
        bar.append(title);
        svg.append(bar);
    }
    if (choose) draggable(svg, range, parts, choose);
    return el("div", { class: "bars" }, svg, el("div", { class: "ends number quiet" }, el("span", {}, show(range[0])), el("span", {}, show(range[1]))));
}

/**
 * Chooses a range by dragging over bars.
 * @param {SVGSVGElement} svg
 * @param {[number, number]} range
 * @param {number} parts
 * @param {(range: [number, number] | null) => void} choose
 */
function draggable(svg, range, parts, choose) {
    const width = (range[1] - range[0]) / parts;
    const barAt = (/** @type {PointerEvent} */ event) => {
        const box = svg.getBoundingClientRect();
        return Math.min(parts - 1, Math.max(0, Math.floor(((event.clientX - box.left) / box.width) * parts)));
    };
    /** The bars where the drag began and is now. @type {[number, number] | null} */
    let drag = null;
    const ends = (/** @type {[number, number]} */ [a, b]) => [Math.min(a, b), Math.max(a, b)];
    svg.classList.add("draggable");
    svg.addEventListener("pointerdown", (event) => {
        if (event.button !== 0) return;
        svg.setPointerCapture(event.pointerId);
        drag = [barAt(event), barAt(event)];
    });
    svg.addEventListener("pointermove", (event) => {
        if (!drag) return;
        drag[1] = barAt(event);
        const [first, last] = ends(drag);
        for (const [i, bar] of svg.querySelectorAll("rect").entries()) bar.classList.toggle("chosen", i >= first && i <= last);
    });
    svg.addEventListener("pointerup", () => {
        if (!drag) return;
        const [first, last] = ends(drag);
        drag = null;
        choose(first === last ? null : [range[0] + first * width, range[0] + (last + 1) * width]);
    });
}
