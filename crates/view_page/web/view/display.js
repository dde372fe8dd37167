// The panel "Display": how a layer is turned into colours, and statistics of its values.

import { el, facts } from "../shared/dom.js";
import { MAPS, MASKS, TRAITS, cssColor } from "./colors.js";
import { barsOf, sampleOf } from "./histogram.js";
import { rangeOf } from "./kinds.js";
import { PERCENTILES, brief } from "./numbers.js";
import { rulerWords, spanWords } from "./ruler.js";
import { countOf, factsOf } from "./tracks.js";

/** @typedef {import("./session.js").Session} Session */

/** Bars of a distribution. */
const BARS = 48;

/** @param {Session} session */
export function displayPanel(session) {
    const { store, looks } = session;
    const sides = session.sides();
    if (!sides.length) return [];
    const kinds = sides.map((side) => looks.look(side.layer).kind);
    const children = [];
    if (kinds.includes("radiance")) children.push(...toneFields(store));
    for (const [i, side] of sides.entries()) {
        if (i > 0 && side.layer === sides[0].layer && side.frame === sides[0].frame && side.camera === sides[0].camera) continue;
        children.push(...layerPart(session, side));
    }
    if (store.state.mode === "difference") children.push(...differencePart(session));
    const check = (/** @type {"boxes" | "names" | "tracks"} */ key, /** @type {string} */ text) =>
        el("label", {}, el("input", { type: "checkbox", id: key, "data-key": key, checked: store.state[key], onchange: (/** @type {any} */ e) => store.set({ [key]: e.target.checked }) }), ` ${text}`);
    children.push(el("h2", {}, "Over the picture"), el("div", { class: "checks" }, check("boxes", "Boxes of all instances"), check("names", "Names on boxes"),
        session.camera?.has_tracks ? check("tracks", "Points that are followed") : null), ...trackPart(session), ...rulerPart(session));
    return children;
}

/** The point that is followed alone. @param {Session} session */
function trackPart({ camera, store, tracks }) {
    const { frame, track } = store.state;
    const followed = store.state.tracks && camera ? tracks.of(camera) : null;
    if (!followed) return [];
    const most = countOf(followed);
    const choose = (/** @type {any} */ e) => store.set({ track: Math.min(most, Math.max(0, Math.round(e.target.valueAsNumber) || 0)) });
    const { isSeen, seen } = track > 0 && track <= most ? factsOf(followed, track, frame) : { isSeen: false, seen: [] };
    return [
        el("div", { class: "field" }, el("label", { for: "track" }, "One point"), el("input", { id: "track", type: "number", min: "0", max: String(most), "data-key": "track", placeholder: `1 to ${most}`, value: track || "", onchange: choose })),
        el("p", { class: "quiet" }, track ? `Point ${track} is ${isSeen ? "seen" : "not seen"} here, and seen in ${seen.length} of ${followed.frames.length} frames.` : "A click on a point, or Shift+P, follows it alone."),
    ];
}

/** The distance between two pixels, or in 3D between two places. @param {Session} session */
function rulerPart(session) {
    const { store } = session;
    const { mode, ruler, span } = store.state;
    const key = mode === "space" ? "span" : "ruler";
    if (!(key === "span" ? span : ruler)) return [];
    const words = key === "span" ? spanWords(span) : rulerWords(session);
    return [el("h2", {}, "Distance"), el("p", { id: "distance" }, words), el("button", { type: "button", "data-key": key, onclick: () => store.set({ [key]: "" }) }, "Remove")];
}

/** What the difference of the two pictures comes to. @param {Session} session */
function differencePart(session) {
    const difference = session.difference();
    if (!difference) return [];
    const { summary } = difference;
    return [
        el("h2", {}, "Difference"),
        ...(summary.of === "share that differs" ? [] : [distribution(difference, null, false)]),
        facts([
            ["Numbers of", summary.of],
            ["Min, max", summary.range && `${brief(summary.range[0])}, ${brief(summary.range[1])}`],
            ["Mean", brief(summary.mean)],
            ...summary.percentiles.map((value, i) => /** @type {[string, string]} */ ([`${PERCENTILES[i]} %`, brief(value)])),
        ]),
    ];
}

/**
 * The distribution of a layer's numbers; bars within `range` stand out.
 * @param {import("./numbers.js").LayerData} data
 * @param {[number, number] | null} range
 * @param {boolean} logarithm
 */
function distribution(data, range, logarithm) {
    const numbers = sampleOf(data);
    const values = logarithm ? numbers.filter((value) => value > 0).map(Math.log10) : numbers;
    if (!values.length) return el("p", { class: "quiet" }, "No pixel has a number.");
    const sorted = values.slice().sort();
    // Outliers would leave one bar for all the rest.
    const [low, high] = [sorted[Math.floor(0.002 * (sorted.length - 1))], sorted[Math.ceil(0.998 * (sorted.length - 1))]];
    const ends = /** @type {[number, number]} */ (range ? (logarithm ? range.map(Math.log10) : range) : [low, high]);
    return barsOf(values, low < high ? [low, high] : [low - 0.5, low + 0.5], BARS, ends, (value) => brief(logarithm ? 10 ** value : value));
}

/** @param {import("./state.js").Store} store */
function toneFields(store) {
    const { state } = store;
    const choice = (/** @type {string} */ id, /** @type {string} */ label, /** @type {"tone" | "expose"} */ key, /** @type {[string, string][]} */ options) =>
        el("div", { class: "field" }, el("label", { for: id }, label), el("select", { id, onchange: (/** @type {any} */ e) => store.set({ [key]: e.target.value }) },
            ...options.map(([value, text]) => el("option", { value, selected: state[key] === value }, text))));
    const set = (/** @type {any} */ e) => Number.isFinite(e.target.valueAsNumber) && store.set({ stops: Math.min(20, Math.max(-20, e.target.valueAsNumber)) });
    return [
        el("h2", {}, "Light"),
        choice("tone", "Curve", "tone", [["hypersim", "Hypersim"], ["filmic", "Filmic (ACES)"], ["linear", "Linear"]]),
        choice("expose", "Exposure by", "expose", [["frame", "this frame"], ["trajectory", "trajectory"], ["fixed", "1 is white"]]),
        el("div", { class: "field" }, el("label", { for: "stops" }, "Stops"), el("span", { class: "with-number" },
            el("input", { type: "range", id: "stops", min: -8, max: 8, step: 0.25, value: state.stops, oninput: set }),
            el("input", { type: "number", "aria-label": "Stops as a number", min: -20, max: 20, step: 0.25, value: state.stops, onchange: set }))),
    ];
}

/** @param {Session} session @param {import("./session.js").Side} side */
function layerPart(session, side) {
    const { store, looks } = session;
    const { layer, data, frame } = side;
    const spec = looks.spec(layer), look = looks.look(layer);
    const children = [el("h2", {}, looks.title(layer), el("span", { class: "quiet" }, `  ${side.camera === session.camera ? "" : `${side.camera.name} `}frame ${frame}`)), el("p", { class: "quiet" }, spec.description)];
    const isQuantity = !["id", "code", "display"].includes(look.kind);
    if (data && isQuantity) children.push(distribution(data, look.kind === "scalar" ? rangeOf(look, data.summary, store.state.ranges[layer], layer in store.state.logs) : null, layer in store.state.logs));
    if (data && (look.kind === "scalar" || look.kind === "flow" || look.kind === "stretched")) children.push(...rangeFields(store, layer, looks.title(layer), look, data.summary));
    if (look.kind === "code") {
        const codes = spec.like === "surface_traits" ? TRAITS.map(({ bit, name, color }) => ({ code: bit, name, color })) : (MASKS[spec.like] ?? []);
        children.push(...codes.map(({ code, name, color }) => el("div", {}, el("span", { class: "swatch", style: `background:${cssColor(color)}` }), ` ${code}  ${name}`)));
    }
    if (data) {
        const { summary, size, dtype } = data;
        children.push(facts([
            ["Type", `${dtype}${spec.channels > 1 ? ` × ${spec.channels}` : ""}`],
            ["Pixels", `${size[1]} × ${size[0]}`],
            ["Unit", spec.unit],
            ["Space", spec.space],
            ["Nothing hit", spec.sentinel],
            ...(!isQuantity ? [] : /** @type {[string, any][]} */ ([
                ["Numbers of", summary.of],
                ["Min, max", summary.range && `${brief(summary.range[0])}, ${brief(summary.range[1])}`],
                ["Mean", brief(summary.mean)],
                ...summary.percentiles.map((value, i) => [`${PERCENTILES[i]} %`, brief(value)]),
                ["Without number", `${summary.without} px`],
            ])),
        ]));
    }
    return children;
}

/**
 * @param {import("./state.js").Store} store
 * @param {string} layer
 * @param {string} title of the layer
 * @param {import("./kinds.js").Look} look
 * @param {import("./numbers.js").Summary} summary
 */
function rangeFields(store, layer, title, look, summary) {
    const [low, high] = rangeOf(look, summary, store.state.ranges[layer], layer in store.state.logs);
    const chosen = layer in store.state.ranges;
    const refused = el("p", { class: "refused", role: "alert" });
    const set = (/** @type {number} */ a, /** @type {number} */ b) => {
        refused.textContent = a < b ? "" : Number.isNaN(a) || Number.isNaN(b) ? "Both ends are numbers." : `The min, ${brief(a)}, must be less than the max, ${brief(b)}.`;
        for (const end of ends) end.setAttribute("aria-invalid", String(!(a < b)));
        if (a < b) store.set({ ranges: { ...store.state.ranges, [layer]: [a, b] } });
    };
    const free = () => {
        const { [layer]: _, ...ranges } = store.state.ranges;
        store.set({ ranges });
    };
    // What was not touched keeps all of its digits; the field shows a few.
    const numberOf = (/** @type {any} */ end, /** @type {number} */ value) => (end.value === brief(value) ? value : end.valueAsNumber);
    const change = () => set(numberOf(ends[0], low), numberOf(ends[1], high));
    const input = (/** @type {number} */ value, /** @type {string} */ label) => el("input", { type: "number", step: "any", value: brief(value), "aria-label": `${label} of ${title}`, onchange: change });
    const ends = [input(low, "Min"), input(high, "Max")];
    const fields = [
        el("div", { class: "field" }, el("span", {}, "Min, max"), el("span", { class: "pair" }, ...ends)),
        refused,
        el("div", { class: "field" }, el("span", {}), el("span", { class: "pair" },
            el("button", { type: "button", "aria-pressed": String(!chosen), title: "1st to 99th percentile of each frame", onclick: free }, "Automatic"),
            el("button", { type: "button", "aria-pressed": String(chosen), title: "The same for all frames", onclick: () => set(low, high) }, "Hold"))),
    ];
    if (look.kind === "scalar") {
        const turn = (/** @type {any} */ event) => {
            const { [layer]: _, ...logs } = store.state.logs;
            store.set({ logs: event.target.checked ? { ...logs, [layer]: true } : logs });
        };
        fields.push(el("div", { class: "checks" }, el("label", {}, el("input", { type: "checkbox", "data-key": `log-${layer}`, checked: layer in store.state.logs, onchange: turn }), " Logarithmic")));
        const map = store.state.maps[layer] ?? look.map;
        fields.unshift(el("div", { class: "field" }, el("label", { for: `map-${layer}` }, "Colours"), el("select", { id: `map-${layer}`, onchange: (/** @type {any} */ e) => store.set({ maps: { ...store.state.maps, [layer]: e.target.value } }) },
            ...MAPS.map((name) => el("option", { value: name, selected: name === map }, name)))));
    }
    return fields;
}
