// The legend beside the name of a layer: what the colours of its picture mean.

import { el } from "../shared/dom.js";
import { mapTable } from "./colors.js";
import { rangeOf } from "./kinds.js";
import { brief } from "./numbers.js";

/**
 * @param {HTMLElement} element
 * @param {import("./session.js").Session} session
 * @param {import("./session.js").Side | undefined} side
 */
export function showLegend(element, session, side) {
    const key = side?.data ? JSON.stringify([side.layer, side.data.summary, session.store.state.ranges[side.layer], session.store.state.maps[side.layer]]) : "";
    if (element.dataset.key === key) return;
    element.dataset.key = key;
    if (!side?.data) return element.replaceChildren();
    const { looks } = session;
    const spec = looks.spec(side.layer), look = looks.look(side.layer);
    const range = rangeOf(look, side.data.summary, session.store.state.ranges[side.layer]);
    const unit = spec.unit ? ` ${spec.unit}` : "";
    const note = (/** @type {string} */ text) => element.replaceChildren(el("span", { class: "quiet ellipsis", title: text }, text));
    switch (look.kind) {
        case "scalar": {
            const bar = el("canvas", { width: 256, height: 1 });
            const image = new ImageData(new Uint8ClampedArray(mapTable(session.store.state.maps[side.layer] ?? look.map)), 256, 1);
            bar.getContext("2d").putImageData(image, 0, 0);
            return element.replaceChildren(el("span", {}, brief(range[0])), bar, el("span", {}, `${brief(range[1])}${unit}`));
        }
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
        case "id": return note(look.of === "class" ? "colours of classes; names in Objects" : "a colour for each number; names in Objects");
        case "code": return note("a colour for each code; meanings in Display");
        case "albedo": return note("0 to 1, gamma 2.2");
        default: return note(toneNote(session));
    }
}

/** @param {import("./session.js").Session} session */
function toneNote(session) {
    const { tone, expose, stops } = session.store.state;
    const words = { hypersim: "Hypersim's gamma", filmic: "filmic", linear: "linear, sRGB" };
    const base = { frame: "90th percentile at 0.8", trajectory: "exposure of the trajectory", fixed: "radiance 1 is white" };
    return `${words[tone]}, ${base[expose]}${stops ? `, ${stops > 0 ? "+" : "−"}${Math.abs(stops)} stops` : ""}`;
}
