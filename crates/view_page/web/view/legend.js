// The legend beside the name of a layer: what the colours of its picture mean.

import { el } from "../shared/dom.js";
import { mapTable } from "./colors.js";
import { lookOfDifference } from "./difference.js";
import { rangeOf } from "./kinds.js";
import { brief } from "./numbers.js";

/**
 * @param {HTMLElement} element
 * @param {import("./session.js").Session} session
 * @param {import("./session.js").Side | undefined} side
 */
export function showLegend(element, session, side) {
    const key = side?.data ? JSON.stringify([side.layer, side.data.summary, session.store.state.ranges[side.layer], session.store.state.maps[side.layer], session.store.state.logs]) : "";
    if (element.dataset.key === key) return;
    element.dataset.key = key;
    if (!side?.data) return element.replaceChildren();
    const { looks } = session;
    const spec = looks.spec(side.layer), look = looks.look(side.layer);
    const logarithm = side.layer in session.store.state.logs;
    const range = rangeOf(look, side.data.summary, session.store.state.ranges[side.layer], logarithm);
    const unit = spec.unit ? ` ${spec.unit}` : "";
    const note = (/** @type {string} */ text) => element.replaceChildren(el("span", { class: "quiet ellipsis", title: text }, text));
    switch (look.kind) {
        case "scalar":
            return element.replaceChildren(el("span", {}, brief(range[0])), mapBar(session.store.state.maps[side.layer] ?? look.map), el("span", {}, `${brief(range[1])}${unit}${logarithm ? ", log" : ""}`));
        case "flow": {
            const bar = el("canvas", { width: 256, height: 1 });
            const pen = bar.getContext("2d");
            for (let x = 0; x < 256; x++) {
                pen.fillStyle = `hsl(${(x / 256) * 360} 100% 50%)`;
                pen.fillRect(x, 0, 1, 1);
            }
            return element.replaceChildren(el("span", {}, "→"), bar, el("span", {}, `↓ ← ↑ →  full at ${brief(range[1])}${unit}`));
        }
        case "direction": return note("red, green, blue: x, y, z from −1 to 1");
        case "stretched": return note(`red, green, blue: x, y, z from ${brief(range[0])} to ${brief(range[1])}${unit}`);
        case "texture": return note("red u, green v; a chequer of eighths");
        case "id": return note(`${look.of === "class" ? "colours of classes" : "a colour for each number"}; names ${look.of === "plane" ? "under the cursor" : "in Objects"}`);
        case "code": return note("a colour for each code; meanings in Display");
        case "display": return note("as the sensor gives it, 8 bits");
        case "albedo": return note("0 to 1, gamma 2.2");
        default: return note(toneNote(session));
    }
}

/** The colours of a map, from left to right. @param {string} map */
function mapBar(map) {
    const bar = el("canvas", { width: 256, height: 1 });
    bar.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(mapTable(map)), 256, 1), 0, 0);
    return bar;
}

/** The legend of a difference. @param {HTMLElement} element @param {import("./session.js").Session} session */
export function showDifferenceLegend(element, session) {
    const difference = session.difference();
    const key = difference ? JSON.stringify(difference.summary) : "";
    if (element.dataset.key === key) return;
    element.dataset.key = key;
    if (!difference) return element.replaceChildren();
    const { map, range } = lookOfDifference(difference);
    const unit = session.looks.spec(session.store.state.layer).unit;
    if (difference.summary.of === "share that differs") return element.replaceChildren(el("span", {}, `${((difference.summary.mean ?? 0) * 100).toFixed(2)} % of the pixels differ`));
    return element.replaceChildren(el("span", {}, brief(range[0])), mapBar(map), el("span", {}, `${brief(range[1])}${unit ? ` ${unit}` : ""}`));
}

/** @param {import("./session.js").Session} session */
function toneNote(session) {
    const { tone, expose, stops } = session.store.state;
    const words = { hypersim: "Hypersim's gamma", filmic: "filmic", linear: "linear, sRGB" };
    const base = { frame: "90th percentile at 0.8", trajectory: "exposure of the trajectory", fixed: "radiance 1 is white" };
    return `${words[tone]}, ${base[expose]}${stops ? `, ${stops > 0 ? "+" : "−"}${Math.abs(stops)} stops` : ""}`;
}
